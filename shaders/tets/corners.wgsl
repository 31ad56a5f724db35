// #include sponges
// Second pass of `tets::corners`: the tet of every particle, its nodes, and their weights with gradients; `corners.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(5) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_node: array<u32>;
@group(0) @binding(7) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> node_stars: array<u32>;
@group(0) @binding(9) var<storage, read_write> fluid_corners: array<vec4<u32>>;
@group(0) @binding(10) var<storage, read_write> fluid_shares: array<vec4<f32>>;

struct Tet {
    least: f32,
    nodes: vec3<u32>,
    weights: vec4<f32>,
    p: vec3<f32>,
    q: vec3<f32>,
    r: vec3<f32>,
}

// The better of a tet and those around a direction of the star at `base`.
fn better(best: Tet, base: u32, direction: u32, own: vec3<f32>, offset: vec3<f32>, minimum: f32) -> Tet {
    var result = best;
    let tets = node_stars[base + STAR_TETS];
    var rings = RINGS;
    let ring = rings[direction];
    let partner = node_stars[base + STAR_DIRECTIONS + direction];
    let p = node_position[partner].xyz - own;
    for (var k = 0u; k < 4u; k += 1u) {
        if (((tets >> (4u * direction + k)) & 1u) == 0u) {
            continue;
        }
        let nodes = vec3<u32>(partner, node_stars[base + ring[(k + 1u) % 4u]], node_stars[base + ring[k]]);
        let q = node_position[nodes.y].xyz - own;
        let r = node_position[nodes.z].xyz - own;
        let area = cross(q, r);
        var six = dot(p, area);
        if (abs(six) < minimum) {
            six = minimum;
        }
        let inverse = 1.0 / six;
        let gradient_p = area * inverse;
        let gradient_q = cross(r, p) * inverse;
        let gradient_r = cross(p, q) * inverse;
        let weights = vec3<f32>(dot(gradient_p, offset), dot(gradient_q, offset), dot(gradient_r, offset));
        let first = 1.0 - weights.x - weights.y - weights.z;
        let smallest = min(min(first, weights.x), min(weights.y, weights.z));
        if (smallest > result.least) {
            result = Tet(smallest, nodes, vec4<f32>(first, weights), gradient_p, gradient_q, gradient_r);
        }
    }
    return result;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let rows = params.fluid_rows;
    let point = fluid_position[row].xyz;
    let end = fluid_controls[row];
    if (end == 0u) {
        fluid_corners[row] = vec4<u32>(params.node_rows);
        for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
            fluid_shares[TET_CORNERS * row + corner] = vec4<f32>(0.0);
        }
        return;
    }
    var nearest = 0u;
    var least = FAR;
    for (var k = 0u; k < end; k += 1u) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let apart = point - control_position[other].xyz;
        let square = dot(apart, apart);
        if (square < least) {
            least = square;
            nearest = other;
        }
    }
    let node = control_node[nearest];
    let base = node * STAR_WORDS;
    let edge = sponges.all[node_stars[base + STAR_SPONGE]].edge;
    let minimum = MINIMUM_TET * 0.5 * (edge * edge * edge);
    let own = node_position[node].xyz;
    let offset = point - own;
    var toward = 0u;
    var most = -FAR;
    for (var direction = 0u; direction < DIRECTIONS; direction += 1u) {
        let to = node_position[node_stars[base + STAR_DIRECTIONS + direction]].xyz - own;
        let square = dot(to, to);
        if (square > 0.0 && dot(to, offset) / square > most) {
            most = dot(to, offset) / square;
            toward = direction;
        }
    }
    var best = Tet(-FAR, vec3<u32>(node), vec4<f32>(1.0, 0.0, 0.0, 0.0), vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0));
    best = better(best, base, toward, own, offset, minimum);
    for (var direction = 0u; direction < DIRECTIONS && best.least < INSIDE_TET; direction += 1u) {
        best = better(best, base, direction, own, offset, minimum);
    }
    var weights = clamp(best.weights, vec4<f32>(SMALLEST_WEIGHT), vec4<f32>(LARGEST_WEIGHT));
    weights += 0.25 * (1.0 - dot(weights, vec4<f32>(1.0)));
    let first = -(best.p + best.q + best.r);
    let limit = STEEPEST / edge * (STEEPEST / edge);
    let steepest = max(max(dot(first, first), dot(best.p, best.p)), max(dot(best.q, best.q), dot(best.r, best.r)));
    let scale = sqrt(limit / max(limit, steepest));
    fluid_corners[row] = vec4<u32>(node, best.nodes);
    fluid_shares[TET_CORNERS * row] = vec4<f32>(first * scale, weights.x);
    fluid_shares[TET_CORNERS * row + 1u] = vec4<f32>(best.p * scale, weights.y);
    fluid_shares[TET_CORNERS * row + 2u] = vec4<f32>(best.q * scale, weights.z);
    fluid_shares[TET_CORNERS * row + 3u] = vec4<f32>(best.r * scale, weights.w);
}
