// #include numbers, scene, cells
// How many points every cell has.

@group(0) @binding(2) var<storage, read_write> counts: array<atomic<u32>>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = row_of(group, groups, lane);
    if (row >= scene.points) {
        return;
    }
    let reached = cells_of(row);
    if (!reached.is_there) {
        return;
    }
    for (var z = reached.first.z; z <= reached.last.z; z++) {
        for (var y = reached.first.y; y <= reached.last.y; y++) {
            for (var x = reached.first.x; x <= reached.last.x; x++) {
                atomicAdd(&counts[cell_index(vec3(x, y, z))], 1u);
            }
        }
    }
}
