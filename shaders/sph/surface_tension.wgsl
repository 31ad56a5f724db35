// #include smoothing, images, shares
// Surface tension from the colour field.
//
//     n = sum_j V_j grad W_ij,   a_i -= sigma / rho_i (sum_j V_j lap W_ij) n / |n|   where |n| H > 1

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

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
    let row = share.row;
    let point = fluid_position[row].xyz;
    let end = fluid_neighbors[row];
    var slopes = vec3<f32>(0.0);
    var laplacian = 0.0;
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        let u = closeness(params.smoothing, dot(apart, apart));
        let weight = fluid_velocity[other][FLUID_VELOCITY_VOLUME] * u * u;
        slopes -= (weight * u) * apart;
        laplacian -= weight * (u + u - 1.0);
    }
    let all = share_sum(lane, vec4<f32>(slopes, laplacian));
    if (!share.writes) {
        return;
    }
    let normal = all.xyz * params.smoothing.gradient;
    let length = sqrt(dot(normal, normal));
    if (length > SURFACE_THRESHOLD / params.smoothing.support_radius) {
        let strength = all.w * params.smoothing.laplacian * fluid_velocity[row][FLUID_VELOCITY_VOLUME]
            * (params.surface_tension / params.particle_mass);
        let own = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(own, own.xyz - (strength / length) * normal);
    }
}
