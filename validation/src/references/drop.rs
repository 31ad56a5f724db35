//! Drops without gravity.

use std::f64::consts::PI;

/// Pressure inside a drop above that outside \[Pa\], `2 sigma / R` \[Laplace\].
#[must_use]
pub fn laplace_pressure(tension: f64, radius: f64) -> f64 {
    2.0 * tension / radius
}

/// Period of the oscillation of a drop in its second mode \[s\]: `omega^2 = l (l - 1) (l + 2) sigma / (rho R^3)` with l = 2,
/// for a nearly spherical drop without viscosity \[Rayleigh 1879\].
#[must_use]
pub fn period(tension: f64, density: f64, radius: f64) -> f64 {
    2.0 * PI / (8.0 * tension / (density * radius.powi(3))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_centimetre_of_water() {
        assert!((laplace_pressure(0.0728, 0.01) - 14.56).abs() < 1e-9);
        assert!((period(0.0728, 998.0, 0.01) - 0.2601).abs() < 2e-4);
        // Negative control: a drop of half the size oscillates faster by the square root of eight.
        let ratio = period(0.0728, 998.0, 0.01) / period(0.0728, 998.0, 0.005);
        assert!((ratio - 8.0_f64.sqrt()).abs() < 1e-12);
    }
}
