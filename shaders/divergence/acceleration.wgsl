// #include smoothing, images, image, shares
// Velocities by the pressure of each other; `acceleration.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let own = fluid_predicted[row];
    var sum = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let there = fluid_predicted[other];
        let apart = apart_from(own.xyz, there.xyz);
        let along = fluid_renormalisation[other].xyz;
        let between = fluid_renormalisation_between[other].xyz;
        sum += (pair_factor(apart) * there[FLUID_PREDICTED_PRESSURE]) * symmetric_times(along, between, apart);
    }
    let all = share_sum3(lane, sum);
    if (share.writes) {
        let push = own[FLUID_PREDICTED_PRESSURE] * fluid_factors[row].xyz + all;
        fluid_correction[row] = vec4<f32>(fluid_velocity[row].xyz + clock.step * push, 0.0);
    }
}
