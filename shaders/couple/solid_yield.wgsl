// #include smoothing, shares
// Compliance of the material of the sponge to the pressure change of a solve; `solid_yield.rs` has the reason.
//
//     y_i = 2 f_i sum_j c_ij f_j (dP_j - dP_i)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_solid_yield: array<f32>;

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
    let follows = fluid_drag_rate[row][FLUID_DRAG_RATE_COMPLIANCE];
    var sum = 0.0;
    if (follows > 0.0) {
        let gradient = params.smoothing.gradient * (params.particle_mass / params.rest_density);
        let end = fluid_neighbors[row];
        for (var k = share.first; k < end; k += SHARES) {
            let other = fluid_neighbors[row + (k + 1u) * rows];
            let there = fluid_predicted[other];
            let apart = own.xyz - there.xyz;
            let u = closeness(params.smoothing, dot(apart, apart));
            let difference = there[FLUID_PREDICTED_PRESSURE_CHANGE] - own[FLUID_PREDICTED_PRESSURE_CHANGE];
            sum += gradient * (u * u * u) * fluid_drag_rate[other][FLUID_DRAG_RATE_COMPLIANCE] * difference;
        }
    }
    let all = share_sum(lane, vec4<f32>(sum, 0.0, 0.0, 0.0)).x;
    if (share.writes) {
        fluid_solid_yield[row] = 2.0 * follows * all;
    }
}
