// #include smoothing, middle, roughness, images, shares
// Iteration of the pressure solve: acceleration by the change of the pressure since the beginning of the step.
//
//     a_i = dP_i B_i + sum_j c_ij dP_j x_ij,   w_i = a_i . x_i - b e / h^2 dP_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let gradient = params.smoothing.gradient * (params.particle_mass / params.rest_density);
    let end = fluid_neighbors[row];
    var part = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let there = fluid_predicted[fluid_neighbors[row + (k + 1u) * rows]];
        let apart = apart_from(own.xyz, there.xyz);
        let u = closeness(params.smoothing, dot(apart, apart));
        part += (gradient * (u * u * u) * there[FLUID_PREDICTED_PRESSURE_CHANGE]) * apart;
    }
    let all = share_sum3(lane, part);
    if (!share.writes) {
        return;
    }
    let sum = all + own[FLUID_PREDICTED_PRESSURE_CHANGE] * fluid_factors[row].xyz;
    let roughness = prompt_roughness() / (clock.step * clock.step);
    fluid_correction[row] = vec4<f32>(sum, dot(sum, own.xyz - middle()) - own[FLUID_PREDICTED_PRESSURE_CHANGE] * roughness);
}
