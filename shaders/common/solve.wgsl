// Where a pressure solve stands, as in `pressure_solve.rs`.
struct Solve {
    // Of the next step along the gradient.
    length: f32,
    tolerance: f32,
    error: f32,
    pressure: f32,
    // Of this step.
    rounds: u32,
    has_converged: u32,
    unused_0: u32,
    unused_1: u32,
}
