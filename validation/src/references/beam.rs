//! Beams and bars of a square cross-section.

use crate::solver::Material;

/// Sag of the free end of a cantilever under its own weight \[m\]: `q L^4 / (8 E I) + q L^2 / (2 kappa G A)`
/// (Timoshenko), with `kappa = 10 (1 + nu) / (12 + 11 nu)` \[C66\].
///
/// `weight` is that of the whole beam \[N\], `side` that of the cross-section \[m\].
#[must_use]
pub fn cantilever_sag(material: &Material, length: f64, side: f64, weight: f64) -> f64 {
    let load = weight / length;
    let (shear, _) = material.lame();
    let share = 10.0 * (1.0 + material.poisson) / (12.0 + 11.0 * material.poisson);
    load * length.powi(4) / (8.0 * material.young * side.powi(4) / 12.0)
        + load * length.powi(2) / (2.0 * share * shear * side.powi(2))
}

/// Frequency of the first bending mode of a cantilever \[1/s\], `1.8751^2 / (2 pi L^2) sqrt(E I / (rho A))`
/// (Euler and Bernoulli), lowered for shear as the static sag is.
#[must_use]
pub fn cantilever_frequency(material: &Material, length: f64, side: f64, mass: f64) -> f64 {
    let line = mass / length;
    let bending = material.young * side.powi(4) / 12.0;
    let slender =
        1.875_104_f64.powi(2) / (2.0 * std::f64::consts::PI * length.powi(2)) * (bending / line).sqrt();
    let stiff = Material { poisson: material.poisson, ..*material };
    let sag = cantilever_sag(&stiff, length, side, 1.0);
    let without_shear = length.powi(3) / (8.0 * bending);
    slender * (without_shear / sag).sqrt()
}

/// Torque that twists a bar by an angle per length \[N m\], `0.1406 G b^4` (Saint-Venant, square).
#[must_use]
pub fn torque(material: &Material, side: f64, twist: f64) -> f64 {
    0.1406 * material.lame().0 * side.powi(4) * twist
}
