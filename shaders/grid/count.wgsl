// #include grid
// First pass of the counting sort: the cell of every point, and the number of points per cell and per page of 4096 cells.
//
// The slot of a point in its cell depends on the order of the threads. `sort_fluid.wgsl` and `controls.wgsl` order the
// points of a cell by their previous row, so that the sort is stable.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> cells: array<u32>;
@group(0) @binding(4) var<storage, read_write> slots: array<u32>;
@group(0) @binding(5) var<storage, read_write> counts: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read_write> page_sums: array<atomic<u32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= grid.rows) {
        return;
    }
    let cell = cell_of(grid, points[row].xyz);
    cells[row] = cell;
    slots[row] = atomicAdd(&counts[cell], 1u);
    atomicAdd(&page_sums[cell / PAGE_CELLS], 1u);
}
