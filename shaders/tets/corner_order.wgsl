// #include control_group, corner_list
// Last pass of `tets::corners`: entries in the order of the particles, so that sums do not depend on the order of threads.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> corner_places: array<u32>;
@group(0) @binding(3) var<storage, read_write> control_corners: array<u32>;

// Which of four entries of a list that ends at `end` come before one.
fn before(first: u32, own: u32, end: u32) -> vec4<u32> {
    let at = first + vec4<u32>(0u, 1u, 2u, 3u);
    let place_at = at - (params.node_rows + 1u);
    let places = vec4<u32>(
        corner_places[place_at.x],
        corner_places[place_at.y],
        corner_places[place_at.z],
        corner_places[place_at.w],
    );
    return select(vec4<u32>(0u), vec4<u32>(1u), (places < vec4<u32>(own)) & (at < vec4<u32>(end)));
}

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
    let list = corner_list(row, is_row);
    let base = params.node_rows + 1u;
    for (var k = list.x + lane % CONTROL_THREADS; k < list.y; k += CONTROL_THREADS) {
        let own = corner_places[k - base];
        var ranks = vec4<u32>(0u);
        // Many in an iteration: lavapipe ends the loops of a thread after 65 535 of them.
        for (var other = list.x; other < list.y; other += 32u) {
            ranks += before(other, own, list.y) + before(other + 4u, own, list.y);
            ranks += before(other + 8u, own, list.y) + before(other + 12u, own, list.y);
            ranks += before(other + 16u, own, list.y) + before(other + 20u, own, list.y);
            ranks += before(other + 24u, own, list.y) + before(other + 28u, own, list.y);
        }
        let rank = ranks.x + ranks.y + ranks.z + ranks.w;
        control_corners[list.x + rank] = own;
    }
}
