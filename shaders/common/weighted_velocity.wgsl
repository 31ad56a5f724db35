// Sum over the controls of a particle of V_a W_ia times their velocity rows.
fn weighted_velocity(row: u32, rows: u32, end: u32) -> vec4<f32> {
    let point = fluid_position[row].xyz;
    var slot = row;
    var sum = vec4<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_controls[slot];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there.w * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        sum += weight * control_velocity[other];
    }
    return sum;
}
