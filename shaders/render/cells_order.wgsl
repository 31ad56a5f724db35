// #include numbers, scene
// Puts the points of every cell into the order of their rows, so that sums over them are the same in every run.

@group(0) @binding(1) var<storage, read_write> cells: array<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let cell = row_of(group, groups, lane);
    if (cell >= scene.cell_count) {
        return;
    }
    let first = scene.cell_list + cells[cell];
    let end = scene.cell_list + cells[cell + 1u];
    for (var k = first + 1u; k < end; k++) {
        let row = cells[k];
        var place = k;
        while (place > first && cells[place - 1u] > row) {
            cells[place] = cells[place - 1u];
            place--;
        }
        cells[place] = row;
    }
}
