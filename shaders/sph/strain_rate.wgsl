// #include smoothing, images, shares
// Acceleration by the rate of strain; `strain.rs` has the formulas. The velocity may be another field in its place.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read> fluid_spin: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

// Whole in the thread that writes.
fn strain_acceleration(share: SharedRow, lane: u32, rows: u32) -> vec3<f32> {
    let point = fluid_position[share.row].xyz;
    let velocity = fluid_velocity[share.row].xyz;
    let spin = fluid_spin[share.row].xyz;
    let end = fluid_neighbors[share.row];
    var part = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[share.row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        let turned = cross(apart, (spin + fluid_spin[other].xyz) * 0.5);
        part += (fluid_velocity[other].xyz - velocity - turned) * closeness(params.smoothing, dot(apart, apart));
    }
    let volume = params.particle_mass / params.rest_density;
    let scale = params.smoothing.viscosity * (2.0 * params.strain_viscosity * volume / params.rest_density);
    return share_sum3(lane, part) * scale;
}

// Adds it to the acceleration.
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
    let acceleration = strain_acceleration(share, lane, params.fluid_rows);
    if (share.writes) {
        let own = fluid_acceleration[share.row];
        fluid_acceleration[share.row] = with_vector(own, own.xyz + acceleration);
    }
}

// Its opposite alone.
@compute @workgroup_size(GROUP)
fn deceleration(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let share = shared_row(group, groups, lane, params.fluid_rows);
    let acceleration = strain_acceleration(share, lane, params.fluid_rows);
    if (share.writes) {
        fluid_acceleration[share.row] = vec4<f32>(-acceleration, 0.0);
    }
}
