//! Which particles are free water, and which are in the pores of a sponge.

use super::cells::Cells;
use super::closure::{Surfel, surfels};
use super::kernels::REACH;
use crate::render::{bands, colour::smooth, sponge::Surface};
use glam::Vec3;

/// Shares that a sponge holds of a particle of free water and of one in pores.
const HELD: (f32, f32) = (0.55, 0.85);
/// A particle of which a sponge holds less is too far from it to be in its pores.
const APART: f32 = 0.05;
/// Distances from the outer surface of a sponge at which a particle is in its pores and is free water, in spacings. At edges of a
/// sponge the share that it holds is that of free water at its faces.
const OUTSIDE: (f32, f32) = (0.2, 0.7);

#[cfg(feature = "gpu")]
shared_with_shaders!(PORES: HELD, APART, OUTSIDE);
/// Particles of one task.
const CHUNK: usize = 512;

/// How much of each particle is free water, 0 to 1.
///
/// `interior` has the share of each particle that a sponge holds, 0 to 1.
pub(in crate::render) fn free(
    positions: &[Vec3],
    interior: &[f32],
    sponge: &Surface,
    spacing: f32,
) -> Vec<f32> {
    let surfels = surfels(sponge, spacing);
    let places: Vec<Vec3> = surfels.iter().map(Surfel::place).collect();
    let reach = REACH * spacing;
    let cells = Cells::new(&places, 0.5 * reach);
    let chunks = bands::map(positions.len().div_ceil(CHUNK), |chunk| {
        let rows = chunk * CHUNK..((chunk + 1) * CHUNK).min(positions.len());
        let share = |row: usize| {
            let free = 1.0 - smooth(HELD.0, HELD.1, interior[row]);
            if free <= 0.0 || interior[row] < APART || surfels.is_empty() {
                return free;
            }
            let distance = distance(positions[row], &surfels, &cells, reach);
            free * smooth(OUTSIDE.0, OUTSIDE.1, distance / spacing)
        };
        rows.map(share).collect::<Vec<_>>()
    });
    chunks.into_iter().flatten().collect()
}

/// Mean distance from the planes of the surfels around a point (m), infinite far from all.
fn distance(point: Vec3, surfels: &[Surfel], cells: &Cells, reach: f32) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    cells.around(point, |places, _| {
        for row in cells.rows(places) {
            let (weight, distance) = surfels[*row as usize].share(point, reach);
            sum += weight * distance;
            weights += weight;
        }
    });
    if weights > 1e-4 { sum / weights } else { f32::INFINITY }
}
