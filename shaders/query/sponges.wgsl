// The first tet that holds each of some points, and what the sponge is like there: a group for each.
//
// a: number of the sponge, or less than 0 outside of all; saturation; six times the volume of the tet; b: velocity of the material.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> question: Question;
@group(0) @binding(2) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_saturation: array<f32>;
@group(0) @binding(5) var<storage, read> tets: array<vec4<u32>>;
@group(0) @binding(6) var<storage, read> tet_sponge: array<u32>;
@group(0) @binding(7) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> answers: array<QueryAnswer>;

var<workgroup> first: atomic<u32>;

// Weights of the corners at a point, and six times the volume.
struct Corners {
    weights: vec4<f32>,
    volume: f32,
}

fn corners_at(tet: vec4<u32>, point: vec3<f32>) -> Corners {
    let a = node_position[tet.x].xyz - point;
    let b = node_position[tet.y].xyz - point;
    let c = node_position[tet.z].xyz - point;
    let d = node_position[tet.w].xyz - point;
    let volume = dot(cross(b - a, c - a), d - a);
    let parts = vec4<f32>(
        dot(cross(b, c), d),
        -dot(cross(a, c), d),
        dot(cross(a, b), d),
        -dot(cross(a, b), c),
    );
    return Corners(parts / volume, volume);
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group_of(group, groups);
    let point = asked[min(index, question.count - 1u)].xyz;
    if (lane == 0u) {
        atomicStore(&first, 0xffffffffu);
    }
    workgroupBarrier();
    for (var tet = lane; tet < params.tet_rows; tet += GROUP_THREADS) {
        let found = corners_at(tets[tet], point);
        // A flat tet holds nothing.
        if (abs(found.volume) > 0.0 && all(found.weights >= vec4<f32>(-IN_TET))) {
            atomicMin(&first, tet);
        }
    }
    workgroupBarrier();
    if (lane != 0u || index >= question.count) {
        return;
    }
    let tet = atomicLoad(&first);
    if (tet == 0xffffffffu) {
        answers[index] = QueryAnswer(vec4<f32>(-1.0), vec4<f32>(0.0));
        return;
    }
    let nodes = tets[tet];
    let found = corners_at(nodes, point);
    var saturation = 0.0;
    var velocity = vec3<f32>(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        velocity += found.weights[k] * node_velocity[nodes[k]].xyz;
        if (params.fluid_rows > 0u) {
            saturation += found.weights[k] * node_saturation[nodes[k]];
        }
    }
    let sponge = f32(tet_sponge[tet]);
    answers[index] = QueryAnswer(vec4<f32>(sponge, saturation, found.volume, 0.0), vec4<f32>(velocity, 0.0));
}
