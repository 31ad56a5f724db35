// The pressure of water at rest.

// Difference of the hydrostatic pressure over a distance; along axes on which space repeats there is no bottom.
fn difference(way: vec3<f32>) -> f32 {
    return 0.5 * dot(select(params.gravity, vec3<f32>(0.0), params.periods > vec3<f32>(0.0)), way);
}
