// The matrix of the implicit viscosity between a pair, over the volume of the own particle, as in `viscosity.rs`. `apart` leads from the
// neighbour, and `relative` is what the own velocity has more, or another field in its place.

fn viscosity_pair(apart: vec3<f32>, relative: vec3<f32>, volume: f32) -> vec3<f32> {
    let square = dot(apart, apart);
    let u = closeness(params.smoothing, square);
    let softening = 0.0025 * params.smoothing.radius * params.smoothing.radius;
    let central = u * u * (dot(relative, apart) / (square + softening));
    let scale = params.smoothing.viscosity * (params.implicit_viscosity / params.particle_mass);
    let central_scale =
        params.smoothing.gradient * (10.0 * params.implicit_central_viscosity / params.particle_mass);
    return (volume * u) * (scale * relative + (central_scale * central) * apart);
}
