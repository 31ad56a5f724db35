// Periodic axes, as in `periodic.rs`.

// A particle that leaves the box along a periodic axis enters it on the other side; values that are not finite stay so.
fn wrapped_into_box(x: vec3<f32>) -> vec3<f32> {
    let low = params.period_low;
    let high = params.period_high;
    let period = params.periods;
    let repeats = period > vec3<f32>(0.0);
    let divisor = select(vec3<f32>(1.0), period, repeats);
    let moved = clamp(x - period * floor((x - low) / divisor), low, high);
    let leaves = repeats & ((x < low) | (x >= high)) & (abs(x) < vec3<f32>(-NO_VALUE));
    return select(x, moved, leaves);
}
