// Origin of coordinates whose size would cost digits.
fn middle() -> vec3<f32> {
    return params.middle;
}
