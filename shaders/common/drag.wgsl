
// 1 / chi, or 0 where there is no drag.
fn weight_inside(chi: f32) -> f32 {
    if (chi > MINIMUM_INTERIOR) {
        return 1.0 / chi;
    }
    return 0.0;
}

// Part of its velocity relative to the sponge that a particle loses, at these linear and inertial rates, by the speed that the drag leaves.
fn drag_strength(drag: vec2<f32>, speed: f32, step: f32) -> f32 {
    let slowed = 1.0 + drag.x * step;
    let root = sqrt(slowed * slowed + 4.0 * step * drag.y * speed);
    let rate = (drag.x + drag.y * (2.0 * speed / (slowed + root))) * step;
    return rate / (1.0 + rate);
}
