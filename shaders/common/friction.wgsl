// Rate of deceleration of a particle by a no-slip surface at a distance, without the limit by the step; `wall_friction.rs`
// has the integral.

fn friction_rate(distance: f32) -> f32 {
    let radius = params.smoothing.support_radius;
    let kinematic = 90.0 * params.wall_viscosity / (params.rest_density * radius * radius);
    let q = clamp(distance * (1.0 / radius), MINIMUM_FRICTION_DISTANCE, 1.0);
    let square = q * q;
    let fourth = square * square;
    let integral = 0.025 - square * (1.0 / 12.0) + fourth * 0.125 - fourth * q * (1.0 / 15.0);
    return max(integral * kinematic / q, 0.0);
}
