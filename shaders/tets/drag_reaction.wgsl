// #include control_group, corner_list, node_drag, corner_drag
// Drag impulses on the nodes, and their moments; `drag_reaction.rs` and `drag_settled.rs` have the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_node: array<u32>;
@group(0) @binding(7) var<storage, read> control_corners: array<u32>;
@group(0) @binding(8) var<storage, read_write> node_drag: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_drag_moment: array<vec4<f32>>;

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
