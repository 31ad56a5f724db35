// First pass of `couple::control_velocity`: velocities of the nodes in the order of the controls, and zero drag.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> control_node: array<u32>;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> control_unfiltered: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_drag: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u) {
        return;
    }
    if (row < params.fluid_rows) {
        fluid_drag[row] = vec4<f32>(0.0);
    }
    if (row < params.node_rows) {
        let node = control_node[row];
        control_unfiltered[row] = with_vector(node_position[node], node_velocity[node].xyz);
    }
}
