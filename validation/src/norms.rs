//! Norms of errors, and fits.

/// Root of the mean square; 0 for nothing.
#[must_use]
pub fn root_mean_square(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}

/// Arithmetic mean; not a number for nothing.
#[must_use]
pub fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value;
        count += 1.0;
    }
    sum / count
}

/// Straight line through points by least squares: slope, and value at 0.
#[must_use]
pub fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let x = points.iter().map(|point| point.0).sum::<f64>() / count;
    let y = points.iter().map(|point| point.1).sum::<f64>() / count;
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    let variance: f64 = points.iter().map(|point| (point.0 - x) * (point.0 - x)).sum();
    let slope = covariance / variance;
    (slope, y - slope * x)
}

/// Value at `x` on the polygon through points whose first coordinates ascend; constant beyond the ends.
#[must_use]
pub fn interpolated(points: &[(f64, f64)], x: f64) -> f64 {
    let after = points.partition_point(|point| point.0 < x);
    match (after.checked_sub(1).and_then(|before| points.get(before)), points.get(after)) {
        (Some(low), Some(high)) => low.1 + (high.1 - low.1) * (x - low.0) / (high.0 - low.0),
        (Some(only), None) | (None, Some(only)) => only.1,
        (None, None) => f64::NAN,
    }
}

/// Argument of the smallest value over a range, to a thousandth of the range: a scan, then a finer one around the best.
#[must_use]
pub fn minimum(range: (f64, f64), mut value: impl FnMut(f64) -> f64) -> f64 {
    let (mut low, mut high) = range;
    let mut best = low;
    for _ in 0..2 {
        let step = (high - low) / 40.0;
        let mut minimum = f64::INFINITY;
        for index in 0..=40 {
            let x = low + step * f64::from(index);
            let found = value(x);
            if found < minimum {
                (minimum, best) = (found, x);
            }
        }
        (low, high) = ((best - step).max(range.0), (best + step).min(range.1));
    }
    best
}

/// Times at which a sampled signal crosses a level upwards, by straight lines between samples.
#[must_use]
pub fn upward_crossings(samples: &[(f64, f64)], level: f64) -> Vec<f64> {
    samples
        .windows(2)
        .filter(|pair| pair[0].1 < level && pair[1].1 >= level)
        .map(|pair| {
            let (t0, t1) = (pair[0].0, pair[1].0);
            t0 + (t1 - t0) * (level - pair[0].1) / (pair[1].1 - pair[0].1)
        })
        .collect()
}

/// First time at which a sampled signal reaches a level from either side, by straight lines between samples.
#[must_use]
pub fn first_crossing(samples: &[(f64, f64)], level: f64) -> Option<f64> {
    let crosses =
        |pair: &&[(f64, f64)]| (pair[0].1 - level) * (pair[1].1 - level) <= 0.0 && pair[0].1 != pair[1].1;
    samples.windows(2).find(crosses).map(|pair| {
        let [(t0, y0), (t1, y1)] = [pair[0], pair[1]];
        t0 + (t1 - t0) * (level - y0) / (y1 - y0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_again_and_a_bent_one_is_not() {
        let straight: Vec<_> = (0..9).map(|i| (f64::from(i), 3.0 * f64::from(i) - 2.0)).collect();
        let (slope, offset) = line(&straight);
        assert!((slope - 3.0).abs() < 1e-12 && (offset + 2.0).abs() < 1e-12);
        let bent: Vec<_> = straight.iter().map(|(x, y)| (*x, y + x * x)).collect();
        assert!((line(&bent).0 - 3.0).abs() > 1.0);
    }

    #[test]
    fn interpolation_hits_points_and_halves_and_stays_level_outside() {
        let points = [(1.0, 2.0), (2.0, 4.0), (4.0, 0.0)];
        for (x, y) in [(0.0, 2.0), (1.0, 2.0), (1.5, 3.0), (2.0, 4.0), (3.0, 2.0), (9.0, 0.0)] {
            assert!((interpolated(&points, x) - y).abs() < 1e-12, "{x}");
        }
        assert!(interpolated(&[], 1.0).is_nan());
    }

    #[test]
    fn the_least_of_a_parabola_and_the_period_of_a_zigzag_are_found() {
        assert!((minimum((0.0, 2.0), |x| (x - 0.7) * (x - 0.7)) - 0.7).abs() < 2e-3);
        let zigzag: Vec<_> = (0..40).map(|i| (f64::from(i), if i % 4 < 2 { -1.0 } else { 1.0 })).collect();
        let crossings = upward_crossings(&zigzag, 0.0);
        assert_eq!(first_crossing(&zigzag, 0.5), Some(1.75));
        assert_eq!(first_crossing(&zigzag[2..], 0.0), Some(3.5));
        assert_eq!(first_crossing(&zigzag, 1.5), None);
        assert!(
            crossings.len() > 5 && crossings.windows(2).all(|pair| (pair[1] - pair[0] - 4.0).abs() < 1e-12)
        );
    }
}
