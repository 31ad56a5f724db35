//! Height of the water surface.

use sorb::World;

/// Wendland's C2 smoothing function at a distance over the support radius, times the cube of that radius.
fn kernel(q: f64) -> f64 {
    if q < 1.0 { 21.0 / (2.0 * std::f64::consts::PI) * (1.0 - q).powi(4) * (4.0 * q + 1.0) } else { 0.0 }
}

/// Height of the surface at points of the plane, where the volume fraction of water falls to a half \[m\].
///
/// The fraction is the sum of W times particle volumes with a support of two spacings. A lattice that fills space up to a
/// plane then has its surface in that plane, half a spacing above its last layer. Points without water below give nothing.
/// Points nearer than two spacings to a wall or body lack the particles there.
pub(crate) fn heights(world: &World, points: &[(f64, f64)]) -> Vec<f64> {
    let spacing = world.scene().fluid.as_ref().map_or(1.0, |fluid| f64::from(fluid.spacing));
    let radius = 2.0 * spacing;
    let volume = spacing.powi(3) / radius.powi(3);
    // The sum over a lattice, which is not exactly 1.
    let full: f64 = (-2..=2)
        .flat_map(|x| (-2..=2).flat_map(move |y| (-2..=2).map(move |z| (x, y, z))))
        .map(|(x, y, z): (i32, i32, i32)| volume * kernel(f64::from(x * x + y * y + z * z).sqrt() / 2.0))
        .sum();
    let positions = world.particle_positions();
    points
        .iter()
        .filter_map(|(x, z)| {
            let near: Vec<(f64, f64)> = positions
                .iter()
                .filter_map(|row| {
                    let (dx, dz) = (f64::from(row[0]) - x, f64::from(row[2]) - z);
                    let square = dx * dx + dz * dz;
                    (square < radius * radius).then(|| (f64::from(row[1]), square))
                })
                .collect();
            let share = |y: f64| -> f64 {
                near.iter()
                    .map(|(height, square)| {
                        volume * kernel(((height - y) * (height - y) + square).sqrt() / radius)
                    })
                    .sum()
            };
            let top = near.iter().map(|particle| particle.0).fold(f64::NEG_INFINITY, f64::max);
            if !top.is_finite() {
                return None;
            }
            // From above, so that a void inside the water is no surface.
            let step = 0.1 * spacing;
            let mut y = top + radius;
            while y > top - 4.0 * radius {
                y -= step;
                let below = share(y);
                if below >= 0.5 * full {
                    let above = share(y + step);
                    return Some(y + step * (below - 0.5 * full) / (below - above));
                }
            }
            None
        })
        .collect()
}
