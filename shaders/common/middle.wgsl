// Where coordinates are taken from where their size would cost digits.
fn middle() -> vec3<f32> {
    return params.middle.xyz;
}
