// #include smoothing, sponges, control_group
// Saturation of every node, and the control pressure that follows from it.
//
//     S_a = sum_i V_0 W_ia / (phi chi_a)        p_a = -p_e (1 + g max(1 - S_a, 0)),  0 at surface nodes

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(6) var<storage, read> node_traits: array<NodeTraits>;
@group(0) @binding(7) var<storage, read> control_node: array<u32>;
@group(0) @binding(8) var<storage, read_write> control_saturation: array<f32>;
@group(0) @binding(9) var<storage, read_write> control_suction: array<f32>;
@group(0) @binding(10) var<storage, read_write> node_saturation: array<f32>;

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
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = 0.0;
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let apart = own.xyz - fluid_position[control_fluid[first + 1u + k]].xyz;
        part += shape(closeness(params.coupling, dot(apart, apart)));
    }
    let sum = control_sum(lane, vec4<f32>(part, 0.0, 0.0, 0.0)).x;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let node = control_node[row];
    let traits = node_traits[node];
    let sponge = sponges.all[traits.sponge];
    let volume = params.particle_mass / params.rest_density;
    let saturation = sum * params.coupling.value * volume / (sponge.porosity * traits.interior);
    let pressure = control_pressure(sponge, saturation, 0.0);
    control_saturation[row] = saturation;
    control_suction[row] = pressure * traits.suction * own[CONTROL_POSITION_VOLUME];
    node_saturation[node] = saturation;
}
