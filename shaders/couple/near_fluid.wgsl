// #include grid, shares, ball
// For every particle, the controls within the coupling radius; the list has the layout of `fluid_neighbors.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> fluid_controls: array<u32>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

var<private> list_row: u32;

fn visit_run(point: vec3<f32>, begin: u32, end: u32) {
    let radius = params.coupling.support_radius;
    for (var other = begin; other < end; other += 1u) {
        let apart = point - control_position[other].xyz;
        if (dot(apart, apart) < radius * radius) {
            if (found < params.control_capacity) {
                fluid_controls[list_row + (found + 1u) * params.fluid_rows] = other;
            }
            found += 1u;
        }
    }
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let share = shared_row(group, groups, lane, params.fluid_rows);
    let capacity = params.control_capacity;
    list_row = share.row;
    let length = find(share, lane, fluid_position[share.row].xyz, params.coupling.support_radius, capacity);
    if (share.is_last) {
        fluid_controls[share.row] = length;
        if (length > capacity) {
            atomicMax(&extremes[EXTREME_CONTROLS], length);
        }
    }
}
