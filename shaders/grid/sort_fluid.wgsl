// #include grid
// Last pass of the counting sort: brings the particles into the order of their cells, those of one cell in the order
// they had.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> grouped: array<u32>;
@group(0) @binding(3) var<storage, read> starts: array<u32>;
@group(0) @binding(4) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> id: array<u32>;
@group(0) @binding(7) var<storage, read_write> sorted_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> sorted_velocity: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> sorted_id: array<u32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = row_of(group, groups, lane);
    if (clock.running == 0u || slot >= grid.wrap.w) {
        return;
    }
    let source = grouped[slot];
    let point = position[source];
    let cell = cell_of(grid, point.xyz);
    let begin = starts[cell];
    let end = starts[cell + 1u];
    var row = begin;
    for (var other = begin; other < end; other += 1u) {
        if (grouped[other] < source) {
            row += 1u;
        }
    }
    sorted_position[row] = point;
    sorted_velocity[row] = velocity[source];
    sorted_id[row] = id[source];
}
