
// 1 / chi, or 0 where there is no drag.
fn weight_inside(chi: f32) -> f32 {
    if (chi > MINIMUM_INTERIOR) {
        return 1.0 / chi;
    }
    return 0.0;
}
