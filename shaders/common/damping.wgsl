// What of the difference is damped in a second.
fn damping_rate() -> f32 {
    let crossing = clock.step * fluid_pressure_solve.speed / params.spacing;
    return min(PART_PER_CROSSING * crossing, MAXIMUM_PART) / (clock.step * params.lattice_moment);
}
