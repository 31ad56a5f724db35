//! Arithmetic of single numbers as processors have it.

/// The smaller number, by one instruction: the second where one is not a number.
#[inline]
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The larger number, by one instruction: the second where one is not a number.
#[inline]
pub(super) fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// Largest whole number that is not above a value, and the rest. Without the call that `floor` is on old processors.
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates and sends NaN to 0; callers bound the value"
)]
#[inline]
pub(super) fn whole(value: f32) -> (i32, f32) {
    let cut = value as i32;
    let floor = if cut as f32 > value { cut.wrapping_sub(1) } else { cut };
    (floor, value - floor as f32)
}
