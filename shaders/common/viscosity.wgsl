// The matrix of the implicit viscosity between a pair, as in `viscosity.rs`. `apart` is the difference of positions to the
// neighbour, and `relative` that of velocities, or of another field in their place.

fn viscosity_pair(apart: vec3<f32>, relative: vec3<f32>) -> vec3<f32> {
    let square = dot(apart, apart);
    let volume = params.particle_mass / params.rest_density;
    let u = closeness(params.smoothing, square);
    let softening = SOFTENING * params.smoothing.support_radius * params.smoothing.support_radius;
    let central = u * u * (dot(relative, apart) / (square + softening));
    let scale = params.smoothing.viscosity * (params.implicit_viscosity * volume / params.rest_density);
    let central_scale =
        params.smoothing.gradient * (10.0 * params.implicit_central_viscosity * volume / params.rest_density);
    return u * (scale * relative + (central_scale * central) * apart);
}

// Whether there is viscosity between pairs: all may be by the rate of strain.
fn has_viscous_pairs() -> bool {
    return params.implicit_viscosity + params.implicit_central_viscosity > 0.0;
}
