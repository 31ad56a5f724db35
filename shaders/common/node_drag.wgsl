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
