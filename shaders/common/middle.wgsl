// Where coordinates are taken from where their size would cost digits.
fn middle() -> vec3<f32> {
    return 0.5 * params.wall_low.w * (params.wall_low.xyz + params.wall_high.xyz);
}
