//! Floating bodies.

use crate::norms::interpolated;

/// Added mass of a square prism in heave over `rho L^3`, by draft over L.
///
/// Half of the added mass of the prism and its image above the surface. For zero draft this is a square plate in open water
/// (`C_A = 0.579` of `pi L^3 / 4`). Otherwise it is a prism of twice the draft (`C_A = 0.68` of `L^2 b` at `b = L`, 0.36 at 2 L). Both are
/// from \[DNV-RP-C205, appendix D\]. Exact for fast heave in deep and wide water; a tank raises it by some per cent.
const ADDED_MASS: [(f64, f64); 3] = [(0.0, 0.227), (0.5, 0.34), (1.0, 0.36)];

/// Period of heave of a square prism \[s\], `2 pi sqrt((m + m_a) / (rho g L^2))`.
///
/// `length` is the side of the square, `draft` the depth that it floats at \[m\].
#[must_use]
pub fn heave_period(length: f64, draft: f64, gravity: f64) -> f64 {
    let added = interpolated(&ADDED_MASS, draft / length) * length;
    2.0 * std::f64::consts::PI * ((draft + added) / gravity).sqrt()
}
