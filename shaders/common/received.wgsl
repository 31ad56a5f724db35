// Sum over the particles of a control of V_a W_ia times the drag row; all threads of the control take part.
fn received_drag(own: vec4<f32>, row: u32, is_row: bool, lane: u32) -> vec4<f32> {
    let scale = own[CONTROL_POSITION_VOLUME] * params.coupling.value;
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var sum = vec4<f32>(0.0);
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_position[other].xyz;
        let weight = scale * shape(closeness(params.coupling, dot(apart, apart)));
        sum += fluid_drag[other] * weight;
    }
    return control_sum(lane, sum);
}
