// State of the solve for the implicit viscosity, as in `viscosity_solve.rs`.
struct ViscositySolve {
    // Of the step along the direction, and of that direction in the next one.
    length: f32,
    share: f32,
    residual: f32,
    change: f32,
    // Of this step.
    rounds: u32,
    has_converged: u32,
    // By the tolerance.
    is_solved: u32,
    unused: u32,
}
