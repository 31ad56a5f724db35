// #include sums, end_of_round
// After a round of a pressure solve: how far to go in the next one, and whether there is one.

@group(0) @binding(0) var<storage, read_write> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> solve_sums: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_pressure_solve: Solve;
@group(0) @binding(4) var<storage, read_write> extremes: array<u32, EXTREME_COUNT>;

fn take_round(lane: u32) {
    // Sums of missing groups stay zero.
    let groups = arrayLength(&solve_sums) / SOLVE_SUM_ROWS;
    var own = vec4<f32>(0.0);
    var rest = vec4<f32>(0.0);
    for (var k = lane; k < groups; k += GROUP_THREADS) {
        own += solve_sums[k * SOLVE_SUM_ROWS];
        rest += solve_sums[k * SOLVE_SUM_ROWS + 1u];
    }
    let sums = group_row(lane, own, false);
    let others = group_row(lane, rest, false);
    if (lane == 0u) {
        choose_length(sums, others);
    }
}

fn choose_length(sums: vec4<f32>, others: vec4<f32>) {
    let particles = f32(max(params.fluid_rows, 1u));
    let rounds = fluid_pressure_solve.rounds + 1u;
    fluid_pressure_solve.rounds = rounds;
    fluid_pressure_solve.error = sums.x / particles;
    fluid_pressure_solve.pressure = sqrt(others.x / particles);
    extremes[EXTREME_PRESSURE] = bitcast<u32>(fluid_pressure_solve.pressure);
    // A solve for the divergence has a first round that changes no pressure, and stands light bodies.
    let still = params.divergence;
    let most = select(1.0, params.lightest, params.divergence != 0u);
    let largest = UNEVENNESS * fluid_pressure_solve.tolerance;
    let is_even = still == 0u || others.y / particles <= largest * largest * (largest * largest);
    let is_small = fluid_pressure_solve.error <= fluid_pressure_solve.tolerance && is_even && rounds > still;
    let is_over = is_small || rounds >= params.solve_rounds;
    fluid_pressure_solve.is_converged = select(0u, 1u, is_over);
    fluid_pressure_solve.length = FIRST_LENGTH * most;
    let below = select(sums.w, sums.z, rounds % 2u == 0u);
    let above = select(sums.z, sums.y, rounds % 2u == 0u);
    if (rounds > 1u + still && sums.z > 0.0 && below > 0.0) {
        let ratio = above / below;
        if (is_finite(ratio)) {
            fluid_pressure_solve.length = clamp(ratio, MINIMUM_LENGTH * most * most, MAXIMUM_LENGTH);
        }
    }
}

fn has_converged() -> bool {
    return fluid_pressure_solve.is_converged != 0u;
}

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    run_round(lane, false);
}

@compute @workgroup_size(GROUP_THREADS)
fn last(@builtin(local_invocation_index) lane: u32) {
    run_round(lane, true);
}
