// Their sum, which the cells over the images have for their number of points. Sets the sums of the pages to zero for the next step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_image_first: array<u32>;
@group(0) @binding(3) var<storage, read_write> image_line_sums: array<u32>;
@group(0) @binding(4) var<storage, read_write> image_grid: Grid;
@group(0) @binding(5) var<storage, read_write> extremes: array<atomic<u32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    let pages = arrayLength(&image_line_sums);
    for (var page = lane; page < pages; page += GROUP_THREADS) {
        image_line_sums[page] = 0u;
    }
    if (lane == 0u) {
        let count = fluid_image_first[params.fluid_rows];
        image_grid.rows = min(count, params.image_capacity);
        if (count > params.image_capacity) {
            atomicMax(&extremes[EXTREME_IMAGES], count);
        }
    }
}
