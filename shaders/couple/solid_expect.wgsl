// #include sponges
// Velocities of the nodes, the volume of their material, and the impulses that are expected of all but the pressure;
// `solid_expect.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_driven: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(7) var<storage, read> node_volume: array<f32>;
@group(0) @binding(8) var<storage, read> control_node: array<u32>;
@group(0) @binding(9) var<storage, read_write> control_material: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> control_expected: array<vec4<f32>>;

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
    let v = node_velocity[node].xyz;
    let solid = 1.0 - sponges.all[node_sponge[node]].porosity;
    control_material[row] = vec4<f32>(v, solid * node_volume[node]);
    let driven = node_driven[node];
    let inverse_mass = node_position[node][NODE_POSITION_INVERSE_MASS];
    var expected = vec3<f32>(0.0);
    if (inverse_mass > 0.0 && driven[NODE_DRIVEN_STEP] > 0.0) {
        expected = (clock.step / (driven[NODE_DRIVEN_STEP] * inverse_mass)) * (v - driven.xyz);
    }
    control_expected[row] = vec4<f32>(expected, 0.0);
}
