// #include numbers, scene, scan
// The first place of every page of cells in the list: one group for all.

@group(0) @binding(1) var<storage, read_write> page_sums: array<u32>;

@compute @workgroup_size(PAGE_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    let share = (scene.cell_pages + PAGE_THREADS - 1u) / PAGE_THREADS;
    let first = lane * share;
    let end = min(first + share, scene.cell_pages);
    var own = 0u;
    for (var page = first; page < end; page++) {
        own += page_sums[page];
    }
    var place = sum_before(lane, own);
    for (var page = first; page < end; page++) {
        let count = page_sums[page];
        page_sums[page] = place;
        place += count;
    }
}
