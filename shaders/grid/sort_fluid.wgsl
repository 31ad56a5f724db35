// #include grid
// Last pass of the counting sort: moves the particles into the order of their cells, those of one cell in their previous
// order.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> fluid_grid: Grid;
@group(0) @binding(2) var<storage, read> fluid_grouped: array<u32>;
@group(0) @binding(3) var<storage, read> fluid_starts: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_position_next: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_velocity_next: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_id_next: array<u32>;
@group(0) @binding(7) var<storage, read_write> fluid_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_id: array<u32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let slot = row_of(group, groups, lane);
    if (clock.running == 0u || slot >= fluid_grid.rows) {
        return;
    }
    let source = fluid_grouped[slot];
    let point = fluid_position_next[source];
    let cell = cell_of(fluid_grid, point.xyz);
    let begin = fluid_starts[cell];
    let end = fluid_starts[cell + 1u];
    var place = begin;
    for (var other = begin; other < end; other += 1u) {
        if (fluid_grouped[other] < source) {
            place += 1u;
        }
    }
    fluid_position[place] = point;
    fluid_velocity[place] = fluid_velocity_next[source];
    fluid_id[place] = fluid_id_next[source];
}
