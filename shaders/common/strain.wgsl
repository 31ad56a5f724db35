// Acceleration by the strains of the pairs of a particle, whole in the thread that writes; `strain.rs` has the formulas. Needs `smoothing`,
// `images` and `shares`. The pass binds `fluid_position`, `fluid_velocity`, `fluid_neighbors` and `fluid_spin`.

fn strain_acceleration(share: SharedRow, lane: u32, rows: u32) -> vec3<f32> {
    let point = fluid_position[share.row].xyz;
    let velocity = fluid_velocity[share.row].xyz;
    let spin = fluid_spin[share.row].xyz;
    let end = fluid_neighbors[share.row];
    var part = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[share.row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        let turned = cross(apart, (spin + fluid_spin[other].xyz) * 0.5);
        part += (fluid_velocity[other].xyz - velocity - turned) * closeness(params.smoothing, dot(apart, apart));
    }
    let volume = params.particle_mass / params.rest_density;
    let scale = params.smoothing.viscosity * (2.0 * params.strain_viscosity * volume / params.rest_density);
    return share_sum3(lane, part) * scale;
}
