// Wendland's C2 function, as in `smoothing.rs`; all values are zero at and beyond the support radius.

// u = 1 - r / H, at least zero, from the squared distance.
fn closeness(smoothing: Smoothing, square: f32) -> f32 {
    return max(1.0 - sqrt(square) * smoothing.inverse_radius, 0.0);
}

// W over `value`: u^4 (5 - 4 u).
fn shape(u: f32) -> f32 {
    let square = u * u;
    return square * square * (5.0 - 4.0 * u);
}
