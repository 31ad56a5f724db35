// #include numbers, scene, scan
// The first place of every cell in the list, and the end of the last one.

@group(0) @binding(1) var<storage, read> counts: array<u32>;
@group(0) @binding(2) var<storage, read> page_sums: array<u32>;
@group(0) @binding(3) var<storage, read_write> cells: array<u32>;

@compute @workgroup_size(PAGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let page = group.y * groups.x + group.x;
    let first = (page * PAGE_THREADS + lane) * PAGE_SHARE;
    var own = 0u;
    for (var k = 0u; k < PAGE_SHARE; k++) {
        if (first + k < scene.cell_count) {
            own += counts[first + k];
        }
    }
    let before = sum_before(lane, own);
    if (page >= scene.cell_pages) {
        return;
    }
    var place = page_sums[page] + before;
    for (var k = 0u; k < PAGE_SHARE; k++) {
        if (first + k < scene.cell_count) {
            cells[first + k] = place;
            place += counts[first + k];
        }
    }
    if (first < scene.cell_count && first + PAGE_SHARE >= scene.cell_count) {
        cells[scene.cell_count] = place;
    }
}
