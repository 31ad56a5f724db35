// #include grid
// Images in the order of their cells, those of one cell in the order of the images.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> grouped: array<u32>;
@group(0) @binding(3) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> image_order: array<u32>;

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
    let image = grouped[row];
    let cell = cell_of(grid, points[image].xyz);
    let begin = starts[cell];
    let end = starts[cell + 1u];
    var place = begin;
    for (var other = begin; other < end; other += 1u) {
        if (grouped[other] < image) {
            place += 1u;
        }
    }
    image_order[place] = image;
}
