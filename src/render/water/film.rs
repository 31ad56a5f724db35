//! Films: water thinner than a layer of particles on a sponge is wetness and gloss, not a surface.

use super::grid::{Grid, SLAB};
use crate::render::{bands, colour::smooth, sponge::Surface};
use glam::Vec3;

/// Thickness of the thickest film, in spacings.
const THICKEST: f32 = 1.0;
/// Distance from the sponge within which the surface of thicker water sinks, in spacings.
pub(super) const REACH: f32 = 3.0;
/// Distance from a sponge at which water makes a film, in spacings. Then the densities of none and of a whole film, less the level of the
/// surface.
const HEIGHT: f32 = 0.4;
const DENSITIES: (f32, f32) = (-0.4, 0.0);

#[cfg(feature = "gpu")]
shared_with_shaders!(FILM: THICKEST, REACH, HEIGHT, DENSITIES);

/// Densities on the nodes of a grid after the surface has sunk towards sponges. A film sinks into them, water that is thicker
/// than [`REACH`] keeps its surface, and water between them meets the sponge without a step.
///
/// `distances` are those of the nodes from the sponges (m), infinite far from them; empty without a sponge.
pub(super) fn sink(grid: &Grid, values: Vec<f32>, distances: &[f32], spacing: f32) -> Vec<f32> {
    if distances.is_empty() {
        return values;
    }
    let (layer, reach) = (grid.layer(), REACH * spacing);
    let mut sunk = values.clone();
    bands::each_band(&mut sunk, layer, SLAB, |first, band| {
        for (index, value) in band.iter_mut().enumerate() {
            let node = first * layer + index;
            let distance = distances[node];
            if distance >= reach {
                continue;
            }
            let rest = 1.0 - (distance / reach).max(0.0);
            let away = slope(grid, distances, node) * (THICKEST * spacing * rest * rest);
            let (x, row) = (node % grid.sides[0], node / grid.sides[0]);
            let place = grid.node(x, row % grid.sides[1], row / grid.sides[1]) + away;
            *value = grid.between(&values, place);
        }
    });
    sunk
}

/// Gradient of the distance from the sponge at a node, no longer than 1.
fn slope(grid: &Grid, distances: &[f32], node: usize) -> Vec3 {
    let own = distances[node];
    let strides = [1, grid.sides[0], grid.layer()];
    let along = |axis: usize| {
        let stride = strides[axis];
        let at =
            |place: Option<usize>| place.and_then(|place| distances.get(place)).filter(|d| d.is_finite());
        let difference = match (at(node.checked_sub(stride)), at(node.checked_add(stride))) {
            (Some(before), Some(after)) => 0.5 * (after - before),
            (Some(before), None) => own - before,
            (None, Some(after)) => after - own,
            (None, None) => 0.0,
        };
        difference * grid.inverse[axis]
    };
    Vec3::new(along(0), along(1), along(2)).clamp_length_max(1.0)
}

/// How much free water covers each node of the sponges, 0 to 1, from the densities before the surface sinks.
pub(super) fn films(grid: &Grid, values: &[f32], sponge: &Surface, spacing: f32) -> Vec<f32> {
    let film = |(place, normal): (&Vec3, &Vec3)| {
        let above = *place + *normal * (HEIGHT * spacing);
        smooth(DENSITIES.0, DENSITIES.1, grid.between(values, above))
    };
    sponge.positions.iter().zip(&sponge.normals).map(film).collect()
}
