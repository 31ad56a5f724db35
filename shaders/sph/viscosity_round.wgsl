// #include sums, end_of_round
// After a round of a solve for the implicit viscosity: whether there is another one.

@group(0) @binding(0) var<storage, read_write> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> viscosity_sums: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_viscosity_solve: ViscositySolve;

fn take_round(lane: u32) {
    // Sums of missing groups stay zero.
    var own = vec4<f32>(0.0);
    for (var k = lane; k < arrayLength(&viscosity_sums); k += GROUP_THREADS) {
        own += viscosity_sums[k];
    }
    let sums = group_row(lane, own, false);
    if (lane != 0u) {
        return;
    }
    let particles = f32(max(params.fluid_rows, 1u));
    let rounds = fluid_viscosity_solve.rounds + 1u;
    fluid_viscosity_solve.rounds = rounds;
    fluid_viscosity_solve.residual = sqrt(sums.x / particles);
    fluid_viscosity_solve.change = sqrt(sums.y / particles);
    let is_solved = fluid_viscosity_solve.residual <= params.viscosity_tolerance * fluid_viscosity_solve.change;
    let is_over = is_solved || rounds >= params.viscosity_rounds;
    fluid_viscosity_solve.is_solved = select(0u, 1u, is_solved);
    fluid_viscosity_solve.is_converged = select(0u, 1u, is_over);
}

fn has_converged() -> bool {
    return fluid_viscosity_solve.is_converged != 0u;
}

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    run_round(lane, false);
}

@compute @workgroup_size(GROUP_THREADS)
fn last(@builtin(local_invocation_index) lane: u32) {
    run_round(lane, true);
}
