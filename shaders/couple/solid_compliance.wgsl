// #include sponges
// Third pass of `couple::solid_moments`: what nodes respond to impulses with.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> control_node: array<u32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(8) var<storage, read> node_wetting: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> control_compliance: array<vec4<f32>>;

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
    let sponge = sponges.all[node_sponge[node]];
    var softer = 1.0;
    if (params.has_wetting != 0u) {
        softer -= sponge.wetting.softening * node_wetting[node][NODE_WETTING_WETNESS];
    }
    let modulus = softer * (sponge.mu + sponge.lambda / 3.0);
    let stiffness = 8.0 * control_position[row][CONTROL_POSITION_VOLUME] / (sponge.edge * sponge.edge) * modulus;
    let elastic = HELD_BY_NEIGHBORS * clock.step * (clock.step + sponge.damping) * stiffness;
    let drawn = control_compliance[row][CONTROL_COMPLIANCE_COMPLIANCE];
    let inverse_mass = node_position[node][NODE_POSITION_INVERSE_MASS];
    var response = 0.0;
    if (inverse_mass > 0.0) {
        response = 1.0 / (1.0 / inverse_mass + drawn + elastic);
    }
    control_compliance[row] = vec4<f32>(response, drawn * response, 0.0, control_material[row][CONTROL_MATERIAL_VOLUME]);
}
