// #include sponges, sponge_sums
// Sums over the nodes of a sponge, a workgroup for each of its parts. Where all of it is one part the workgroup adds up those of the
// sponges in contact with it as well, and has the motion.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<storage, read> sponge_ranges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_free: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_reaction: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> node_drag: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> node_drag_moment: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> sponge_motions: array<vec4<f32>>;

fn term(row: u32, origin: vec3<f32>) -> Sums {
    let x = node_position[row].xyz - origin;
    var weight = node_reaction[row][NODE_REACTION_MASS];
    if (weight > 0.0) {
        weight += node_drag[row][NODE_DRAG_MASS];
    }
    let mass = abs(weight);
    let y = node_predicted[row];
    var lacking = node_reaction[row].xyz;
    var moment = vec3<f32>(0.0);
    if (y[NODE_PREDICTED_INVERSE_MASS] > 0.0) {
        lacking += node_drag[row].xyz - (y.xyz - node_free[row].xyz) * (clock.inverse_step / y[NODE_PREDICTED_INVERSE_MASS]);
        moment = node_drag_moment[row].xyz;
    }
    return Sums(
        vec4<f32>(x, 1.0) * mass,
        vec4<f32>(x * x * mass, max(weight, 0.0)),
        vec3<f32>(x.x * x.y, x.x * x.z, x.y * x.z) * mass,
        lacking,
        moment + cross(x, lacking),
    );
}

@compute @workgroup_size(SPONGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let parts = part_count();
    let own = group.x / parts;
    let part = group.x % parts;
    if (clock.running == 0u || sponges.all[own].solver != SOLVER_VBD) {
        return;
    }
    let first = first_joined(own);
    let origin = origin_of(first);
    var found = no_sums();
    let begin = select(own, first, parts == 1u);
    let end = select(own + 1u, sponge_count(), parts == 1u);
    for (var index = begin * VERTEX_COLORS; index < end * VERTEX_COLORS; index += 1u) {
        let sponge = index / VERTEX_COLORS;
        if (is_joined(own, sponge)) {
            let range = sponge_ranges[sponge * RANGES + index % VERTEX_COLORS];
            for (var row = range.x + part * SPONGE_THREADS + lane; row < range.y; row += parts * SPONGE_THREADS) {
                found = join(found, term(row, origin));
            }
        }
    }
    let all = sum_of_group(lane, found);
    if (lane == 0u && parts == 1u) {
        store_motion(own, origin, all);
    } else if (lane == 0u) {
        store_part(own, part, all);
    }
}
