// Interior value below which there is no drag.
const OUTSIDE: f32 = 1.0e-3;

// 1 / chi, or 0 where there is no drag.
fn weight_inside(chi: f32) -> f32 {
    if (chi > OUTSIDE) {
        return 1.0 / chi;
    }
    return 0.0;
}
