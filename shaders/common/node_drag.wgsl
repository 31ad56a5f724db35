// Drag impulses on a node with the mass of fluid that moves with it, and their moments.
struct NodeDrag {
    impulse: vec4<f32>,
    moment: vec4<f32>,
}

// Stores them. A node that does not respond no longer moves fluid with it. The pass binds `node_drag` and `node_drag_moment`.
fn store_drag(node: u32, drag: NodeDrag, responds: bool) {
    let mass = select(0.0, drag.impulse[NODE_DRAG_MASS], responds);
    node_drag[node] = vec4<f32>(drag.impulse.xyz, mass);
    node_drag_moment[node] = drag.moment;
}

// All of a pass: threads of a control compute the drag on it with `drag_on_control`, which the pass includes.
fn on_node(group: vec3<u32>, groups: vec3<u32>, lane: u32, responds: bool) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let drag = drag_on_control(row, is_row, lane);
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    store_drag(control_node[row], drag, responds);
}
