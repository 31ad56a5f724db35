// Sum over the controls of a particle of V_a W_ia times their velocity rows; all threads of a group take part. Needs `shares`.
fn weighted_velocity(share: SharedRow, rows: u32, lane: u32) -> vec4<f32> {
    let point = fluid_position[share.row].xyz;
    let end = fluid_controls[share.row];
    var sum = vec4<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[share.row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        sum += weight * control_velocity[other];
    }
    return share_sum(lane, sum);
}
