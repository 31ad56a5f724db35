// Drag of the particles in the tets of a node on it. All threads of the control take part.
fn drag_on_control(row: u32, is_row: bool, lane: u32) -> NodeDrag {
    let list = corner_list(row, is_row);
    let own = control_position[min(row, params.node_rows - 1u)].xyz;
    var part = vec4<f32>(0.0);
    var turning = vec3<f32>(0.0);
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        let place = control_corners[k];
        let impulse = fluid_shares[place][CORNER_WEIGHT] * fluid_drag[place / TET_CORNERS];
        part += impulse;
        turning += cross(fluid_position[place / TET_CORNERS].xyz - own, impulse.xyz);
    }
    let sum = control_sum(lane, part);
    // The memory of the sum is used again.
    workgroupBarrier();
    return NodeDrag(sum, control_sum(lane, vec4<f32>(turning, 0.0)));
}
