// #include grid, scan
// First pass of the prefix sums of grids with more than 256 pages. One workgroup replaces the sums of the pages by the sums of all pages
// before them. `count.wgsl` has computed the former.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read_write> page_sums: array<u32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    let pages = grid.cells / PAGE_CELLS + 1u;
    var before = 0u;
    for (var first = 0u; first < pages; first += 1024u) {
        // Four consecutive pages per thread.
        let own = first + lane * 4u;
        var values = vec4<u32>(0u);
        for (var k = 0u; k < 4u; k += 1u) {
            if (own + k < pages) {
                values[k] = page_sums[own + k];
            }
        }
        let scan = group_scan(lane, vec4<u32>(values.x + values.y + values.z + values.w, 0u, 0u, 0u));
        var sum = before + scan.before.x;
        before += scan.all.x;
        for (var k = 0u; k < 4u; k += 1u) {
            if (own + k < pages) {
                page_sums[own + k] = sum;
            }
            sum += values[k];
        }
    }
}
