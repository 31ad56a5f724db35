// #include smoothing, control_group, received
// Applies the drag to the nodes: u_a = u0_a + sum_i w_ia J_i / m_a.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_node: array<u32>;
@group(0) @binding(6) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(7) var<storage, read> control_unfiltered: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> control_velocity: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_velocity: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let own = control_position[min(row, params.node_rows - 1u)];
    let received = received_drag(own, row, is_row, lane).xyz;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let before = control_unfiltered[row];
    let after = with_vector(before, before.xyz + received * before[CONTROL_UNFILTERED_INVERSE_MASS]);
    control_velocity[row] = after;
    let node = control_node[row];
    node_velocity[node] = with_vector(node_velocity[node], after.xyz);
}
