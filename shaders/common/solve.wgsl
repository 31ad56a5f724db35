// Where a pressure solve stands, as in `pressure_solve.rs`.
struct Solve {
    // Of the next step along the gradient.
    length: f32,
    tolerance: f32,
    error: f32,
    pressure: f32,
}
