// #include numbers, scene, surfels, grid
// Distances of the nodes from sponges, where there is water.

@group(0) @binding(3) var<storage, read> sums: array<u32>;
@group(0) @binding(4) var<storage, read_write> away: array<f32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = row_of(group, groups, lane);
    if (index >= node_count()) {
        return;
    }
    // A row of the grid has whole eights.
    let eight = index & 0xfffffff8u;
    var wettest = 0u;
    for (var k = 0u; k < 8u; k++) {
        wettest = max(wettest, sums[eight + k]);
    }
    away[index] = FAR_AWAY;
    if (of_fixed(wettest) > DENSITY_THIN) {
        away[index] = surfel_distance(node_place(node_of(index)));
    }
}
