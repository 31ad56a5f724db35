// #include smoothing, sponges, control_group
// Zero-distance constraints between nodes and the particles around them: the opposite of the suction.
//
//     F_a = sum_i k_ia (x_i - x_a),   k_ia = -r V_0 V_a p_a (210 / (pi H^5)) (1 - q_ia)^3

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_node: array<u32>;
@group(0) @binding(6) var<storage, read> control_suction: array<f32>;
@group(0) @binding(7) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(8) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(10) var<storage, read_write> node_acceleration: array<vec4<f32>>;

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
    let point = control_position[min(row, params.node_rows - 1u)].xyz;
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = vec3<f32>(0.0);
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let apart = point - fluid_position[control_fluid[first + 1u + k]].xyz;
        let u = closeness(params.coupling, dot(apart, apart));
        part += (u * u * u) * apart;
    }
    let sum = control_sum(lane, vec4<f32>(part, 0.0)).xyz;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let volume = params.particle_mass / params.rest_density;
    let force = sum * (control_suction[row] * params.coupling.gradient * volume);
    let node = control_node[row];
    let scale = sponges.all[node_sponge[node]].reaction * node_position[node][NODE_POSITION_INVERSE_MASS];
    let before = node_acceleration[node];
    node_acceleration[node] = with_vector(before, before.xyz + force * scale);
}
