//! Slow flow between two moving plates, in a channel without net flow.

/// Velocity over that of the plates, at a place between them, 0 to 1, where both move the same way. The return flow in the
/// middle makes a parabola without net flow \[Poiseuille\].
#[must_use]
pub fn returning(place: f64) -> f64 {
    1.0 - 6.0 * place * (1.0 - place)
}

/// The same where they move opposite ways, over that of the upper one: a straight line \[Couette\].
#[must_use]
pub fn sheared(place: f64) -> f64 {
    2.0 * place - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plates_take_the_fluid_along_and_nothing_is_lost() {
        for profile in [returning, sheared] {
            let samples = (0..1000).map(|k| profile((f64::from(k) + 0.5) / 1000.0));
            assert!(samples.sum::<f64>().abs() < 1e-2);
            assert_eq!(profile(1.0), 1.0);
        }
        assert_eq!((returning(0.0), sheared(0.0)), (1.0, -1.0));
        // Both are solutions: second differences are constant, and zero for the line.
        let bend = |profile: fn(f64) -> f64, y: f64| profile(y + 0.1) - 2.0 * profile(y) + profile(y - 0.1);
        assert!((bend(returning, 0.3) - bend(returning, 0.6)).abs() < 1e-12);
        assert!(bend(sheared, 0.3).abs() < 1e-12);
    }
}
