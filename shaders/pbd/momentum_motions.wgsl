// #include sponges, sponge_sums
// The rigid motion of a large sponge, by the sums over its parts and those of the sponges in contact with it. One workgroup per sponge.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> sponges: Sponges;
@group(0) @binding(2) var<storage, read> sponge_ranges: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> sponge_motions: array<vec4<f32>>;

@compute @workgroup_size(SPONGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let own = group.x;
    if (clock.running == 0u || sponges.all[own].solver != SOLVER_VBD) {
        return;
    }
    let parts = part_count();
    let first = first_joined(own);
    var found = no_sums();
    for (var sponge = first; sponge < sponge_count(); sponge += 1u) {
        if (is_joined(own, sponge)) {
            for (var part = lane; part < parts; part += SPONGE_THREADS) {
                found = join(found, part_of(sponge, part));
            }
        }
    }
    let all = sum_of_group(lane, found);
    if (lane == 0u) {
        store_motion(own, origin_of(first), all);
    }
}
