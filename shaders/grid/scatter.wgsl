// #include grid
// Rows grouped by cell, those of one cell in any order. Sets the sums of the pages to zero for the next step: there are no
// more pages than threads.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> slots: array<u32>;
@group(0) @binding(4) var<storage, read> starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> grouped: array<u32>;
@group(0) @binding(6) var<storage, read_write> page_sums: array<u32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u) {
        return;
    }
    if (row <= grid.cells / PAGE_CELLS) {
        page_sums[row] = 0u;
    }
    if (row >= grid.rows) {
        return;
    }
    grouped[starts[cells[row]] + slots[row]] = row;
}
