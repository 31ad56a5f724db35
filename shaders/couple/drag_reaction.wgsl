// #include smoothing, control_group, node_drag, drag_on_node
// Drag impulses on the nodes, and their moments; `drag_reaction.rs` and `drag_settled.rs` have the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_node: array<u32>;
@group(0) @binding(6) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(7) var<storage, read_write> node_drag: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> node_drag_moment: array<vec4<f32>>;

fn on_node(group: vec3<u32>, groups: vec3<u32>, lane: u32, responds: bool) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let own = control_position[min(row, params.node_rows - 1u)];
    let drag = drag_on_node(own, row, is_row, lane);
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    store_drag(control_node[row], drag, responds);
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    on_node(group, groups, lane, true);
}

// Nodes no longer move fluid with them.
@compute @workgroup_size(GROUP_THREADS)
fn settled(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    on_node(group, groups, lane, false);
}
