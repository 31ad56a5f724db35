//! The smoothing function W(r): Wendland's C2 function \[W95; DA12\].
//!
//! ```text
//! W(r) = 21 / (2 pi H^3) (1 - q)^4 (4 q + 1),   q = r / H < 1
//! ```
//!
//! Differs from the paper, which names no function. Its gradient is consistent with its value, so that pressure conserves
//! energy. It has no pairing instability. Gradient and value need one square root and no division.

use std::f64::consts::PI;

use crate::{
    lanes::{self, Simd, f32x8},
    layout::{constants, layout},
};

constants! {
    /// What is added to squared distances where they are divided by, over the square of the support radius.
    const SOFTENING: f64 = 0.0025;
}

layout! {
    /// Wendland's C2 kernel for one support radius.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Wendland as Smoothing {
        /// Distance at which the kernel becomes zero, H \[m\].
        pub support_radius: f32,
        inverse_radius: f32,
        value: f32,
        gradient: f32,
        laplacian: f32,
        viscosity: f32,
    }
}

impl Wendland {
    /// The function with the given support radius H \[m\].
    #[must_use]
    pub fn new(support_radius: f32) -> Self {
        Self::scaled(support_radius, 1.0)
    }

    /// The function over its sum in a cubic lattice of the given spacing \[m\]. Particles of the mass of a cube of a spacing then have rest
    /// density in a lattice. Without that the sum over so few particles differs from the integral.
    #[must_use]
    pub fn normalised(support_radius: f32, spacing: f32) -> Self {
        Self::scaled(support_radius, 1.0 / Self::lattice_sum(f64::from(support_radius), f64::from(spacing)))
    }

    fn scaled(support_radius: f32, factor: f64) -> Self {
        let h = f64::from(support_radius);
        Self {
            support_radius,
            inverse_radius: (1.0 / h) as f32,
            value: (factor * 21.0 / (2.0 * PI * h.powi(3))) as f32,
            gradient: (factor * 210.0 / (PI * h.powi(5))) as f32,
            laplacian: (factor * 630.0 / (PI * h.powi(5))) as f32,
            viscosity: (factor * 45.0 / (PI * h.powi(5))) as f32,
        }
    }

    /// Value at a squared distance, in f64: the formula itself.
    #[must_use]
    pub fn value_f64(support_radius: f64, distance: f64) -> f64 {
        let q = distance / support_radius;
        if q < 1.0 {
            21.0 / (2.0 * PI * support_radius.powi(3)) * (1.0 - q).powi(4) * (4.0 * q + 1.0)
        } else {
            0.0
        }
    }

    /// Gradient at x divided by -x, in f64.
    #[must_use]
    pub fn gradient_f64(support_radius: f64, distance: f64) -> f64 {
        let q = distance / support_radius;
        if q < 1.0 { 210.0 / (PI * support_radius.powi(5)) * (1.0 - q).powi(3) } else { 0.0 }
    }

    /// Sum of `spacing^3 W` over a cubic lattice with a particle at the origin: It is 1 if it equals the integral.
    #[must_use]
    pub fn lattice_sum(support_radius: f64, spacing: f64) -> f64 {
        let value = |distance| spacing.powi(3) * Self::value_f64(support_radius, distance);
        over_lattice(support_radius, spacing, value)
    }

    /// The sum of \[MCG03, eq. 22\] for a Laplacian of 1 in a cubic lattice of the right density. 1 if it equals the
    /// integral, 0.96 at a support of two spacings.
    #[must_use]
    pub fn lattice_viscosity(support_radius: f64, spacing: f64) -> f64 {
        let scale = 45.0 / (PI * support_radius.powi(5)) / 6.0;
        let sum =
            over_lattice(support_radius, spacing, |r| scale * (1.0 - r / support_radius).max(0.0) * r * r);
        sum * spacing.powi(3) / Self::lattice_sum(support_radius, spacing)
    }

    /// The same for the viscosity along the line between particles \[M92, eq. 4.1\], as the mean over all directions of the
    /// lattice. It is less along its axes, more across its diagonals.
    #[must_use]
    pub fn lattice_central_viscosity(support_radius: f64, spacing: f64) -> f64 {
        let softening = SOFTENING * support_radius * support_radius;
        let pair = |r: f64| Self::gradient_f64(support_radius, r) * r.powi(4) / (r * r + softening) / 3.0;
        over_lattice(support_radius, spacing, pair) * spacing.powi(3)
            / Self::lattice_sum(support_radius, spacing)
    }

    /// Term added to squared distances in denominators: a twentieth of H, squared \[m^2\].
    #[must_use]
    pub fn softening(&self) -> f32 {
        SOFTENING as f32 * self.support_radius * self.support_radius
    }

    /// Gradient at x over `-x`, at a distance.
    #[must_use]
    pub(crate) fn gradient_at(&self, distance: f32) -> f32 {
        let closeness = (1.0 - distance * self.inverse_radius).max(0.0);
        self.gradient * (closeness * closeness * closeness)
    }

    /// The kernel on eight lanes.
    #[inline(always)]
    pub(crate) fn lanes<S: Simd>(&self, simd: S) -> WendlandLanes<S> {
        let splat = |value| lanes::splat(simd, value);
        WendlandLanes {
            simd,
            inverse_radius: splat(self.inverse_radius),
            value: splat(self.value),
            gradient: splat(self.gradient),
            laplacian: splat(self.laplacian),
            viscosity: splat(self.viscosity),
        }
    }
}

/// The function on eight lanes; all values are exact zeros at and beyond the support radius.
#[derive(Clone, Copy)]
pub(crate) struct WendlandLanes<S: Simd> {
    simd: S,
    inverse_radius: f32x8<S>,
    value: f32x8<S>,
    gradient: f32x8<S>,
    laplacian: f32x8<S>,
    viscosity: f32x8<S>,
}

impl<S: Simd> WendlandLanes<S> {
    /// u = 1 - r / H, at least zero, from the squared distance.
    #[inline(always)]
    pub(crate) fn closeness(self, distance_squared: f32x8<S>) -> f32x8<S> {
        let closeness = lanes::splat(self.simd, 1.0) - distance_squared.sqrt() * self.inverse_radius;
        closeness.max(lanes::splat(self.simd, 0.0))
    }

    /// W / `value_scale` = u^4 (5 - 4 u).
    #[inline(always)]
    pub(crate) fn shape(self, closeness: f32x8<S>) -> f32x8<S> {
        let square = closeness * closeness;
        square * square * (lanes::splat(self.simd, 5.0) - lanes::splat(self.simd, 4.0) * closeness)
    }

    /// W over its shape.
    #[inline(always)]
    pub(crate) fn value_scale(self) -> f32x8<S> {
        self.value
    }

    /// The gradient of W at x is `-gradient_scale u^3 x`.
    #[inline(always)]
    pub(crate) fn gradient_scale(self) -> f32x8<S> {
        self.gradient
    }

    /// The Laplacian of W is `-laplacian_scale u^2 (2 u - 1)`.
    #[inline(always)]
    pub(crate) fn laplacian_scale(self) -> f32x8<S> {
        self.laplacian
    }

    /// The Laplacian of the viscosity function of \[MCG03, eq. 22\] is `viscosity_scale u`, never negative.
    #[inline(always)]
    pub(crate) fn viscosity_scale(self) -> f32x8<S> {
        self.viscosity
    }
}

/// Sum of a function of the distance over a cubic lattice with a particle at the origin.
fn over_lattice(support_radius: f64, spacing: f64, function: impl Fn(f64) -> f64) -> f64 {
    let reach = (support_radius / spacing).ceil() as i32;
    let mut sum = 0.0;
    for (x, y, z) in (-reach..=reach)
        .flat_map(|x| (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z))))
    {
        sum += function(f64::from(x * x + y * y + z * z).sqrt() * spacing);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{SimdLevel, dispatch};

    /// Integral over space of a radial function, by the midpoint rule.
    fn integral(radius: f64, f: impl Fn(f64) -> f64) -> f64 {
        let cells = 20_000;
        let width = radius / f64::from(cells);
        (0..cells)
            .map(|cell| {
                let r = (f64::from(cell) + 0.5) * width;
                4.0 * PI * r * r * f(r) * width
            })
            .sum()
    }

    #[test]
    fn the_integral_of_the_kernel_is_one() {
        let h = 0.37;
        assert!((integral(h, |r| Wendland::value_f64(h, r)) - 1.0).abs() < 1e-6);
        // Negative control: a support that is 1 % too small is noticed.
        assert!((integral(h, |r| Wendland::value_f64(h * 0.99, r * 1.01)) - 1.0).abs() > 1e-3);
        // Second moment of the Laplacian of the viscosity function: 6, so that it gives the true Laplacian.
        let viscosity = 45.0 / (PI * h.powi(5));
        assert!((integral(h, |r| r * r * viscosity * (1.0 - r / h)) - 6.0).abs() < 1e-5);
    }

    #[test]
    fn lanes_agree_with_the_formula_and_with_differences() {
        let h = 0.37_f64;
        let kernel = Wendland::new(h as f32);
        let token = SimdLevel::best().token().expect("the best level is there");
        for step in 1..120 {
            let r = h * f64::from(step) / 100.0;
            let (value, gradient, laplacian) = dispatch!(token, simd => {
                let lanes = kernel.lanes(simd);
                let u = lanes.closeness(lanes::splat(simd, (r * r) as f32));
                let value = lanes.value_scale() * lanes.shape(u);
                let gradient = lanes.gradient_scale() * u * u * u;
                let laplacian = -(lanes.laplacian_scale() * u * u * (u + u - lanes::splat(simd, 1.0)));
                (f64::from(value[0]), f64::from(gradient[0]), f64::from(laplacian[0]))
            });
            let w = |r: f64| Wendland::value_f64(h, r);
            let e = 1e-4 * h;
            let slope = (w(r + e) - w(r - e)) / (2.0 * e);
            let curvature = (w(r + e) - 2.0 * w(r) + w(r - e)) / (e * e);
            let scale = w(0.0);
            assert!((value - w(r)).abs() < 1e-5 * scale);
            assert!((gradient - Wendland::gradient_f64(h, r)).abs() < 1e-5 * scale / (h * h) * 60.0);
            assert!((gradient * r + slope).abs() < 1e-3 * scale / h);
            assert!((laplacian - (curvature + 2.0 * slope / r)).abs() < 1e-2 * scale / (h * h) * 60.0);
        }
    }

    #[test]
    fn lattice_sum_is_near_one() {
        assert!((Wendland::lattice_sum(2.0, 1.0) - 1.0338).abs() < 1e-4);
    }

    #[test]
    fn the_normalised_function_sums_to_one_over_its_lattice() {
        let sum = |own: Wendland| {
            let shape = |r: f64| {
                let u = (1.0 - r / f64::from(own.support_radius)).max(0.0);
                f64::from(own.value) * u.powi(4) * (5.0 - 4.0 * u) * 0.3_f64.powi(3)
            };
            over_lattice(f64::from(own.support_radius), 0.3, shape)
        };
        assert!((sum(Wendland::normalised(0.6, 0.3)) - 1.0).abs() < 1e-6);
        // Negative controls: the function itself, and that for another spacing.
        assert!((sum(Wendland::new(0.6)) - 1.0338).abs() < 1e-4);
        assert!((sum(Wendland::normalised(0.6, 0.25)) - 1.0).abs() > 1e-3);
        let (plain, own) = (Wendland::new(0.6), Wendland::normalised(0.6, 0.3));
        let ratio = own.value / plain.value;
        for (own, plain) in [
            (own.gradient, plain.gradient),
            (own.laplacian, plain.laplacian),
            (own.viscosity, plain.viscosity),
        ] {
            assert!((own / plain / ratio - 1.0).abs() < 1e-6);
        }
        assert_eq!(own.support_radius.to_bits(), plain.support_radius.to_bits());
    }

    #[test]
    fn lattice_viscosity_tends_to_one() {
        let both = |h| [Wendland::lattice_viscosity(h, 1.0), Wendland::lattice_central_viscosity(h, 1.0)];
        for (coarse, fine) in both(2.0).into_iter().zip(both(8.0)) {
            // The softening of denominators remains.
            assert!((coarse - 1.0).abs() > 0.03 && (fine - 1.0).abs() < 0.012, "{coarse} {fine}");
        }
    }
}
