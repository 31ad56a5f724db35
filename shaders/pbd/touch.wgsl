// #include sponges, meeting
// What nodes of sponges that touch do to each other, with friction; `touch.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_normal: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_pairs: array<u32>;
@group(0) @binding(7) var<storage, read_write> node_stars: array<u32>;
@group(0) @binding(8) var<storage, read_write> node_touch: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_touch_stiffness: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> node_touch_between: array<vec4<f32>>;

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
    let own = node_stars[row * STAR_WORDS + STAR_SPONGE];
    let x_a = node_position[row].xyz;
    let y_a = node_predicted[row].xyz;
    let n_a = node_normal[row];
    var force = vec3<f32>(0.0);
    var along = vec3<f32>(0.0);
    var across = vec3<f32>(0.0);
    var lowest = 0xffffffffu;
    var highest = 0u;
    let end = (node_pairs[row] + 1u) * params.node_rows;
    for (var slot = row + params.node_rows; slot < end; slot += params.node_rows) {
        let other = node_pairs[slot];
        let x_b = node_position[other].xyz;
        let y_b = node_predicted[other].xyz;
        let n_b = node_normal[other];
        let pair = pair_of(x_a, x_b, n_a.xyz, n_b.xyz);
        let n = pair.normal;
        let depth = -dot(n, y_a - y_b);
        if (depth <= 0.0) {
            continue;
        }
        let sponge = node_stars[other * STAR_WORDS + STAR_SPONGE];
        let edge = max(contact_edge(own), contact_edge(sponge));
        let modulus_a = sponges.all[own].lambda + sponges.all[own].mu;
        let modulus_b = sponges.all[sponge].lambda + sponges.all[sponge].mu;
        let modulus = 2.0 * modulus_a * modulus_b / (modulus_a + modulus_b);
        let k = CONTACT_STIFFNESS * modulus / edge * opposition(pair) * (n_a[NODE_NORMAL_AREA] * n_b[NODE_NORMAL_AREA] * share(pair, edge));
        let square = 4.0 * depth * depth / (edge * edge);
        let push = k * depth * (1.0 + square);
        var slip = (y_a - x_a) - (y_b - x_b);
        slip -= n * dot(n, slip);
        let friction = 0.5 * (sponges.all[own].friction + sponges.all[sponge].friction);
        let hold = push * friction / max(sqrt(dot(slip, slip)), CREEP_SPEED * clock.step);
        force += n * push - slip * hold;
        let tangent = k * (1.0 + 3.0 * square) - hold;
        along += n * n * tangent + vec3<f32>(hold);
        across += vec3<f32>(n.x * n.y, n.x * n.z, n.y * n.z) * tangent;
        if (sponge != own) {
            lowest = min(lowest, sponge);
            highest = max(highest, sponge);
        }
    }
    if (lowest == 0xffffffffu) {
        lowest = own;
        highest = own;
    }
    node_touch[row] = vec4<f32>(force, f32(lowest));
    node_touch_stiffness[row] = vec4<f32>(along, f32(highest));
    node_touch_between[row] = vec4<f32>(across, 0.0);
    let base = params.node_rows * STAR_WORDS + row * TOUCH_WORDS;
    let words = array<vec3<u32>, 3>(bitcast<vec3<u32>>(force), bitcast<vec3<u32>>(along), bitcast<vec3<u32>>(across));
    for (var k = 0u; k < 3u; k += 1u) {
        node_stars[base + 3u * k] = words[k].x;
        node_stars[base + 3u * k + 1u] = words[k].y;
        node_stars[base + 3u * k + 2u] = words[k].z;
    }
}
