//! Sums over the neighbours of a particle in a cubic lattice, with particle masses such that it has rest density.

use crate::smoothing::Wendland;

/// Sum of `|c_ij x_ij|^2` \[1/m^2\], see `sph::factors`.
#[must_use]
pub fn diagonal(smoothing: &Wendland, spacing: f32) -> f32 {
    sum(smoothing, spacing, |c, _, distance| (c * distance).powi(2))
}

/// Sum of `c_ij x_ij^2` along an axis: 1 for a perfect smoothing function.
#[must_use]
pub fn moment(smoothing: &Wendland, spacing: f32) -> f32 {
    sum(smoothing, spacing, |c, x, _| c * x * x)
}

/// Two numbers of the first layer of a lattice below a plane. They are the length of the sum of `c_ij x_ij` \[1/m\], and the part of a full
/// neighbourhood that it lacks \[1\]. See `divergence::moments`.
#[must_use]
pub fn surface(smoothing: &Wendland, spacing: f32) -> (f32, f32) {
    let moment = sum(smoothing, spacing, |c, x, _| if x > 0.0 { c * x } else { 0.0 });
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    let lack =
        sum(
            smoothing,
            spacing,
            |_, x, distance| {
                if x > 0.0 { volume * Wendland::value_f64(radius, distance) } else { 0.0 }
            },
        );
    (moment, lack)
}

/// Two numbers of a film one particle thick. They are the density over that at rest, and what a particle at a straight edge of it lacks of
/// that \[1\]. See `divergence::retention`.
#[must_use]
pub fn film(smoothing: &Wendland, spacing: f32) -> (f32, f32) {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32;
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    let row = |x: i32| -> f64 {
        let places = (-reach..=reach).map(|y| f64::from(x * x + y * y).sqrt() * d);
        places.map(|distance| volume * Wendland::value_f64(radius, distance)).sum()
    };
    let edge: f64 = (1..=reach).map(row).sum();
    ((row(0) + 2.0 * edge) as f32, edge as f32)
}

/// Sum of a function of `c_ij`, and of the offset along the first axis and the distance of j.
fn sum(smoothing: &Wendland, spacing: f32, function: impl Fn(f64, f64, f64) -> f64) -> f32 {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32;
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    let sites = -reach..=reach;
    let mut sum = 0.0;
    for (x, y, z) in
        sites.clone().flat_map(|x| sites.clone().flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z))))
    {
        let distance = f64::from(x * x + y * y + z * z).sqrt() * d;
        let c = volume * Wendland::gradient_f64(radius, distance);
        sum += function(c, f64::from(x) * d, distance);
    }
    sum as f32
}
