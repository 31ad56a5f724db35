// #include sponges
// First pass of `couple::solid_pressure`: expected positions of the nodes at the end of the step, and the volume of their
// material.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_acceleration: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(7) var<storage, read> control_node: array<u32>;
@group(0) @binding(8) var<storage, read> node_volume: array<f32>;
@group(0) @binding(9) var<storage, read_write> control_solid: array<vec4<f32>>;

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
    let x = node_position[node];
    let v = node_velocity[node];
    var share = 0.0;
    if (x[NODE_POSITION_INVERSE_MASS] > 0.0) {
        share = v[NODE_VELOCITY_FOLLOWED_SHARE];
    }
    let end = x.xyz + clock.step * (v.xyz + (clock.step * share) * node_acceleration[node].xyz);
    let solid = 1.0 - sponges.all[node_sponge[node]].porosity;
    control_solid[row] = vec4<f32>(end, solid * node_volume[node]);
}
