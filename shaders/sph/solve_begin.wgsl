// #include sums
// Before the first round of a pressure solve: the tolerance, which falls with the mean displacement in the step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> solve_sums: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_pressure_solve: Solve;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    // Sums of missing groups stay zero.
    let groups = arrayLength(&solve_sums) / SOLVE_SUM_ROWS;
    var own = 0.0;
    for (var k = lane; k < groups; k += GROUP_THREADS) {
        own += solve_sums[k * SOLVE_SUM_ROWS].x;
    }
    let sum = group_row(lane, vec4<f32>(own, 0.0, 0.0, 0.0), false).x;
    if (lane == 0u) {
        let displacement = sqrt(sum / f32(max(params.fluid_rows, 1u))) / params.spacing;
        let tolerance = max(displacement * ERROR_PER_DISPLACEMENT, MINIMUM_TOLERANCE);
        fluid_pressure_solve = Solve(FIRST_LENGTH, min(tolerance, params.solve_tolerance), 0.0, 0.0, 0u, 0u, 0.0, 0.0);
    }
}
