// Drag of the particles within the coupling radius on a node. All threads of the control take part.
fn drag_on_control(row: u32, is_row: bool, lane: u32) -> NodeDrag {
    let own = control_position[min(row, params.node_rows - 1u)];
    let scale = own[CONTROL_POSITION_VOLUME] * params.coupling.value;
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = vec4<f32>(0.0);
    var turning = vec3<f32>(0.0);
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_position[other].xyz;
        let weight = scale * shape(closeness(params.coupling, dot(apart, apart)));
        let impulse = weight * fluid_drag[other];
        part += impulse;
        turning -= cross(apart, impulse.xyz);
    }
    let sum = control_sum(lane, part);
    // The memory of the sum is used again.
    workgroupBarrier();
    return NodeDrag(sum, control_sum(lane, vec4<f32>(turning, 0.0)));
}
