// #include sponges, meeting
// Normals of surface nodes, as long as their weights, and their areas; `pairs.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_stars: array<u32>;
@group(0) @binding(5) var<storage, read> sponge_boxes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_rest: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> node_normal: array<vec4<f32>>;

// Whether a node may be near another sponge.
fn is_near(sponge: u32, x: vec3<f32>) -> bool {
    for (var other = 0u; other < arrayLength(&sponge_boxes) / BOX_ROWS && other < SPONGES; other += 1u) {
        if (!may_meet(sponge, other)) {
            continue;
        }
        if (other == sponge || (all(x >= sponge_boxes[other * BOX_ROWS].xyz) && all(x <= sponge_boxes[other * BOX_ROWS + 1u].xyz))) {
            return true;
        }
    }
    return false;
}

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
    let base = row * STAR_WORDS;
    let tets = node_stars[base + STAR_TETS];
    let sponge = node_stars[base + STAR_SPONGE];
    let x = node_position[row].xyz;
    node_normal[row] = vec4<f32>(0.0);
    let weight = node_rest[row][NODE_REST_FLATNESS];
    if (weight <= 0.0 || !is_near(sponge, x)) {
        return;
    }
    var rings = RINGS;
    var sum = vec3<f32>(0.0);
    for (var direction = 0u; direction < DIRECTIONS; direction += 1u) {
        let ring = rings[direction];
        let u = node_position[node_stars[base + STAR_DIRECTIONS + direction]].xyz;
        for (var k = 0u; k < 4u; k += 1u) {
            if (((tets >> (4u * direction + k)) & 1u) != 0u) {
                let q = node_position[node_stars[base + ring[(k + 1u) % 4u]]].xyz;
                let r = node_position[node_stars[base + ring[k]]].xyz;
                sum -= cross(q - u, r - u);
            }
        }
    }
    let length = sqrt(dot(sum, sum));
    let area = length / 6.0;
    let edge = sponges.all[sponge].edge;
    if (area > MINIMUM_NODE_AREA * edge * edge) {
        node_normal[row] = vec4<f32>(sum * (weight / length), area);
    }
}
