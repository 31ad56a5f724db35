//! Shear that spreads from two plates into a fluid at rest.

/// Terms of the series. They reach double precision from a hundredth of the time in which viscosity crosses half of the gap.
const TERMS: u32 = 40;

/// Velocity over that of the upper plate, at a place between the plates, 0 to 1, which move opposite ways from time 0 on. A
/// sum of decaying sines \[Couette\].
///
/// `time` is in units of the square of half of their distance over the kinematic viscosity.
#[must_use]
pub fn spreading(place: f64, time: f64) -> f64 {
    let z = 2.0 * place - 1.0;
    let term = |n: u32| {
        let wave = f64::from(n) * std::f64::consts::PI;
        let sign = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * 2.0 / wave * libm::sin(wave * z) * libm::exp(-wave * wave * time)
    };
    z + (1..=TERMS).map(term).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shear_spreads_from_the_plates() {
        for time in [0.02, 0.1, 0.5] {
            assert!((spreading(1.0, time) - 1.0).abs() < 1e-9 && (spreading(0.0, time) + 1.0).abs() < 1e-9);
            assert!(spreading(0.5, time).abs() < 1e-12);
        }
        assert!(spreading(0.75, 0.02) < 0.1 && spreading(0.75, 0.1) < 0.5);
        assert!((spreading(0.75, 3.0) - 0.5).abs() < 1e-9, "a straight line in the end");
        // It is a solution: its rate of change is its second difference.
        let (z, t) = (0.7, 0.1);
        let rate = (spreading(z, t + 1e-5) - spreading(z, t - 1e-5)) / 2e-5;
        let bend = (spreading(z + 1e-3, t) - 2.0 * spreading(z, t) + spreading(z - 1e-3, t)) / 1e-6;
        // Places are over the whole gap, times over half of it.
        assert!((rate - 0.25 * bend).abs() < 1e-4, "{rate} {bend}");
    }
}
