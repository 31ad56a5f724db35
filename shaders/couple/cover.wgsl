// #include sponges, meeting
// How much of the face of every node others cover; `contact_suction.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_normal: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_pairs: array<u32>;
@group(0) @binding(6) var<storage, read> node_traits: array<NodeTraits>;
@group(0) @binding(7) var<storage, read_write> node_cover: array<f32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let x = node_position[row].xyz;
    let normal = node_normal[row].xyz;
    let own = node_traits[row].sponge;
    var sum = 0.0;
    let end = (node_pairs[row] + 1u) * params.node_rows;
    for (var slot = row + params.node_rows; slot < end; slot += params.node_rows) {
        let other = node_pairs[slot];
        let pair = pair_of(x, node_position[other].xyz, normal, node_normal[other].xyz);
        let edge = max(contact_edge(own), contact_edge(node_traits[other].sponge));
        let nearness = clamp(1.0 - pair.gap / (PAIR_GAP * edge), 0.0, 1.0);
        sum += opposition(pair) * (node_normal[other][NODE_NORMAL_AREA] * share(pair, edge)) * nearness;
    }
    node_cover[row] = min(sum, 1.0);
}
