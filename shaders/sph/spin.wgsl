// #include smoothing, images, image, shares
// Spin of the fluid around every particle; `strain.rs` has the formulas. The velocity may be another field in its place.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_spin: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let point = fluid_position[share.row].xyz;
    let velocity = fluid_velocity[share.row].xyz;
    let end = fluid_neighbors[share.row];
    var along_part = vec3<f32>(0.0);
    var between_part = vec3<f32>(0.0);
    var turning_part = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[share.row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        let weighted = apart * closeness(params.smoothing, dot(apart, apart));
        along_part += weighted * apart;
        between_part += weighted.yzx * apart.zxy;
        turning_part += cross(fluid_velocity[other].xyz - velocity, weighted);
    }
    let along = share_sum3(lane, along_part);
    let between = share_sum3(lane, between_part);
    let turning = share_sum3(lane, turning_part);
    if (!share.writes) {
        return;
    }
    let trace = along.x + along.y + along.z;
    if (trace <= 0.0) {
        fluid_spin[share.row] = vec4<f32>(0.0);
        return;
    }
    // Twice the trace of the moments is that of the moments of inertia.
    let scale = 0.5 / trace;
    let a = vec3<f32>(trace * scale + REGULAR) - along * scale;
    let b = -between * scale;
    let minors = a.yzx * a.zxy - b * b;
    let mixed = b.yzx * b.zxy - a * b;
    let determinant = a.x * minors.x + b.z * mixed.z + b.y * mixed.y;
    fluid_spin[share.row] = vec4<f32>(symmetric_times(minors, mixed, turning * scale) / determinant, 0.0);
}
