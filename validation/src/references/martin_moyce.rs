//! The collapse of a column of water, as J. C. Martin and W. J. Moyce filmed it (Phil. Trans. A 244 (1952) 312).
//!
//! A column of base a and height 2 a, `a = 2.25` inches, in a channel. A wrong table of the front circulates, with
//! Z = 1.44 at T = 0.84 and 5.0 at 2.95; the two readings here are independent and agree.

/// Base of the column: 2.25 inches \[m\].
pub const BASE: f64 = 0.05715;

/// Front (their Table 2): `T = t sqrt(2 g / a)`, `Z = x / a`.
pub const FRONT: [(f64, f64); 15] = [
    (0.41, 1.11),
    (0.84, 1.22),
    (1.19, 1.44),
    (1.43, 1.67),
    (1.63, 1.89),
    (1.83, 2.11),
    (1.98, 2.33),
    (2.20, 2.56),
    (2.32, 2.78),
    (2.51, 3.00),
    (2.65, 3.22),
    (2.83, 3.44),
    (2.98, 3.67),
    (3.11, 3.89),
    (3.33, 4.11),
];

/// Front, as read off their Fig. 3: `T`, `Z` as in [`FRONT`].
pub const FRONT_FIGURE: [(f64, f64); 7] = [
    (0.832, 1.217),
    (1.219, 1.474),
    (1.997, 2.292),
    (2.547, 2.995),
    (3.345, 4.134),
    (4.034, 4.944),
    (4.418, 5.881),
];

/// Height left at the wall (their Table 6): `tau = t sqrt(g / a)`, `h / (2 a)`.
pub const HEIGHT: [(f64, f64); 14] = [
    (0.56, 0.94),
    (0.77, 0.89),
    (0.93, 0.83),
    (1.08, 0.78),
    (1.28, 0.72),
    (1.46, 0.67),
    (1.66, 0.61),
    (1.84, 0.56),
    (2.00, 0.50),
    (2.21, 0.44),
    (2.45, 0.39),
    (2.70, 0.33),
    (3.06, 0.28),
    (3.44, 0.22),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::norms::interpolated;

    #[test]
    // The readings are at most 0.063 apart.
    fn both_readings_of_the_front_agree_and_the_wrong_table_does_not() {
        for (time, front) in FRONT_FIGURE.into_iter().filter(|point| point.0 < 3.33) {
            assert!((interpolated(&FRONT, time) - front).abs() < 0.1, "{time}");
        }
        for (time, front) in [(0.84, 1.44), (2.95, 5.0)] {
            assert!((interpolated(&FRONT, time) - front).abs() > 0.2, "{time}");
        }
    }
}
