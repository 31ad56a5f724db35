// #include smoothing, middle, sums, roughness, images, pressure_rows
// Iteration of the pressure solve: the remaining compression, and the sums for `solve_round.wgsl`.
//
//     r_i = r0_i + h^2 (sum_j c_ij a_j . x_ij - a_i . B_i + y_i) + b e sum_j c_ij (dP_j - dP_i)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> solve_sums: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_solid_yield: array<f32>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    let is_row = row < rows;
    var sums = vec4<f32>(0.0);
    var pressure_sum = 0.0;
    if (is_row) {
        let own = fluid_predicted[row];
        let point = own.xyz - middle();
        let gradient = params.smoothing.gradient * (params.particle_mass / params.rest_density);
        let end = fluid_neighbors[row];
        var slot = row;
        var sum = 0.0;
        var pairs = 0.0;
        for (var k = 0u; k < end; k += 1u) {
            slot += rows;
            let other = fluid_neighbors[slot];
            let shift = image_shift(own.xyz - fluid_predicted[other].xyz);
            let apart = (own.xyz - fluid_predicted[other].xyz) + shift;
            let u = closeness(params.smoothing, dot(apart, apart));
            let there = fluid_correction[other];
            let c = gradient * (u * u * u);
            sum += c * (dot(there.xyz, point + shift) - there[FLUID_CORRECTION_ALONG_POSITION]);
            pairs += c;
        }
        let factor = fluid_factors[row];
        let square = clock.step * clock.step;
        let change = own[FLUID_PREDICTED_PRESSURE_CHANGE];
        let away = dot(fluid_correction[row].xyz, factor.xyz) + pairs * change * (prompt_roughness() / square);
        let left = factor[FLUID_FACTORS_COMPRESSION] + (sum - away + fluid_solid_yield[row]) * square;
        let before = pressure_row(fluid_pressure_rows[row]);
        sums = round_sums(before, left);
        pressure_sum = before.pressure * before.pressure;
        fluid_pressure_rows[row][FLUID_PRESSURE_ROWS_COMPRESSION] = left;
    }
    let all = group_row(lane, sums, false);
    let pressures = group_row(lane, vec4<f32>(pressure_sum, 0.0, 0.0, 0.0), false);
    let place = group_of(group, groups);
    if (lane == 0u && place * GROUP < rows) {
        solve_sums[place * SOLVE_SUM_ROWS] = all;
        solve_sums[place * SOLVE_SUM_ROWS + 1u] = pressures;
    }
}
