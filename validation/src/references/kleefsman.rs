//! A dam breaks onto a box: the experiment at MARIN, as K. M. T. Kleefsman et al. describe it (J. Comput. Phys. 206 (2005)
//! 363), test 2 of SPHERIC.
//!
//! The series of the experiment are not in this repository. These are the values that the literature quotes. Axes are those
//! of the scenes: x along the tank, y up, z across.

/// Size of the tank \[m\].
pub const TANK: [f64; 3] = [3.22, 1.0, 1.0];
/// Initial edge of the water along the tank \[m\]; it ends at the wall.
pub const DAM: f64 = 1.992;
/// Its depth \[m\].
pub const DEPTH: f64 = 0.55;
/// Lowest and highest corner of the box \[m\].
pub const BOX: [[f64; 3]; 2] = [[0.6635, 0.0, 0.2955], [0.8245, 0.161, 0.6985]];
/// Gauge of pressure P2, on the face of the box towards the water \[m\].
pub const P2: [f64; 3] = [0.8245, 0.061, 0.471];
/// Gauges of height H2, between box and water, and H4, in the water, along the tank \[m\].
pub const H2: f64 = 0.992;
/// See [`H2`].
pub const H4: f64 = 2.638;
/// Largest pressure at P2 \[Pa\].
pub const PEAK: f64 = 8127.5;
/// Earliest and latest quoted time of arrival at the box \[s\].
pub const ARRIVAL: (f64, f64) = (0.40, 0.45);
/// Lowest and highest quoted value of the largest height at H2 \[m\].
pub const HIGHEST: (f64, f64) = (0.30, 0.36);
/// Initial height at H4 \[m\].
pub const FIRST: f64 = 0.551;

#[cfg(test)]
mod tests {
    use super::*;

    const GRAVITY: f64 = 9.81;

    /// Speed of the front on a dry bed without friction (Ritter 1892) \[m/s\].
    fn front(depth: f64) -> f64 {
        2.0 * (GRAVITY * depth).sqrt()
    }

    /// Whether such numbers are possible. No front is faster than Ritter's. The peak lies between the hydrostatic pressure
    /// and the stagnation pressure of Ritter's front. Without obstacles no wave is higher than the dam.
    fn is_possible(depth: f64, peak: f64, arrival: f64, highest: f64) -> bool {
        let way = DAM - BOX[1][0];
        let stagnation = 500.0 * front(depth).powi(2);
        arrival > way / front(depth)
            && (1000.0 * GRAVITY * depth..stagnation).contains(&peak)
            && highest < depth
    }

    #[test]
    fn what_is_quoted_is_possible_and_its_misreadings_are_not() {
        assert!(is_possible(DEPTH, PEAK, ARRIVAL.0, HIGHEST.1));
        assert!(is_possible(DEPTH, PEAK, ARRIVAL.1, HIGHEST.0));
        // Pressure in other units, a front that is too fast, a depth in feet.
        assert!(!is_possible(DEPTH, PEAK / 6.9, ARRIVAL.0, HIGHEST.1));
        assert!(!is_possible(DEPTH, PEAK, 0.2, HIGHEST.1));
        assert!(!is_possible(DEPTH / 3.28, PEAK, ARRIVAL.0, HIGHEST.1));
        assert!((DEPTH - FIRST).abs() < 2e-3);
    }
}
