// Zero-distance constraints between nodes and the particles around them: the opposite of the suction.
//
//     F_a = sum_i k_ia (x_i - x_a),   k_ia = -r V_0 V_a p_a (210 / (pi H^5)) (1 - q_ia)^3

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_node: array<u32>;
@group(0) @binding(6) var<storage, read> control_suction: array<f32>;
@group(0) @binding(7) var<storage, read> list: array<u32>;
@group(0) @binding(8) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(10) var<storage, read_write> node_acceleration: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.node_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let point = control_position[row].xyz;
    let end = list[row];
    var slot = row;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let apart = point - position[list[slot]].xyz;
        let u = closeness(params.coupling, dot(apart, apart));
        sum += (u * u * u) * apart;
    }
    let volume = params.particle_mass / params.rest_density;
    let force = sum * (control_suction[row] * params.coupling.gradient * volume);
    let node = control_node[row];
    let scale = sponges.all[node_sponge[node]].reaction * node_position[node].w;
    let before = node_acceleration[node];
    node_acceleration[node] = vec4<f32>(before.xyz + force * scale, before.w);
}
