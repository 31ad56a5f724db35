// Second pass of `couple::solid_kick`: nodes receive the force of the pressure; `solid_kick.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> control_node: array<u32>;
@group(0) @binding(3) var<storage, read> control_force: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_impulse: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> node_acceleration: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> node_driven: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let node = control_node[row];
    let before = node_acceleration[node];
    let inverse_mass = node_position[node][NODE_POSITION_INVERSE_MASS];
    node_acceleration[node] = with_vector(before, before.xyz + control_force[row].xyz * inverse_mass);
    node_driven[node] = vec4<f32>(node_velocity[node].xyz + control_impulse[row].xyz * inverse_mass, clock.step);
}
