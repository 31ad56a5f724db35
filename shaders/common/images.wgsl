// The nearest periodic images of neighbours, as in `periodic.rs`.

// Shift from the difference of two positions to that of the nearest image.
fn image_shift(apart: vec3<f32>) -> vec3<f32> {
    if (params.has_periods == 0u) {
        return vec3<f32>(0.0);
    }
    return select(vec3<f32>(0.0), -sign(apart) * params.periods, abs(apart) > params.half_periods);
}

// `a - b`, with the nearest image of b.
fn apart_from(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {
    let apart = a - b;
    if (params.has_periods == 0u) {
        return apart;
    }
    return apart + image_shift(apart);
}
