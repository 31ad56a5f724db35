//! The surface of the free water: kernels of the particles, their density on a grid, and what rays ask of it.
//!
//! Each file is one pass. Passes have no state, take slices and give columns.

mod bricks;
mod cells;
mod closure;
mod density;
mod field;
mod film;
mod grid;
mod kernels;
mod pores;
#[cfg(test)]
mod tests;
mod walls;

pub(super) use field::Field;
pub(super) use pores::free;
#[cfg(feature = "gpu")]
pub(super) use {
    bricks::Content,
    cells::Cells,
    closure::{Surfel, surfels},
    grid::Grid,
    kernels::REACH,
    walls::Walls,
};

use super::{shapes::Solid, sponge::Surface};
#[cfg(not(feature = "gpu"))]
use closure::surfels;
use glam::Vec3;
#[cfg(not(feature = "gpu"))]
use grid::Grid;
use kernels::Kernel;
#[cfg(not(feature = "gpu"))]
use walls::Walls;

/// Constants that shaders know.
#[cfg(feature = "gpu")]
pub(super) const CONSTANTS: &[&[super::shared::Constant]] = &[
    bricks::CONSTANTS,
    closure::CONSTANTS,
    density::CONSTANTS,
    field::CONSTANTS,
    film::CONSTANTS,
    kernels::CONSTANTS,
    pores::CONSTANTS,
];

/// Farthest particles from the others in an open scene, in spacings.
pub(super) const LOST: f32 = 600.0;

/// What the passes read.
pub(super) struct Input<'a> {
    /// Finite positions of the particles (m).
    pub(super) positions: &'a [Vec3],
    /// Share of each particle that is free water, 0 to 1.
    pub(super) free: &'a [f32],
    /// Distance of particles at rest (m).
    pub(super) spacing: f32,
    /// Lowest and highest corner of a container (m).
    pub(super) container: Option<(Vec3, Vec3)>,
    pub(super) sponge: &'a Surface,
    pub(super) bodies: &'a [Solid<'a>],
}

/// A ball of water that is smaller than the distance of rays on the picture may be (m).
#[derive(Clone, Copy, Debug)]
pub(super) struct Drop {
    pub(super) centre: Vec3,
    pub(super) radius: f32,
}

/// The free water.
pub(super) struct Water {
    pub(super) field: Field,
    /// Drops that are alone.
    pub(super) drops: Vec<Drop>,
    /// How much water covers each node of the sponges, 0 to 1.
    pub(super) films: Vec<f32>,
}

/// The free water, or nothing without any.
pub(super) fn water(input: &Input<'_>) -> Option<Water> {
    let walls = Walls { container: input.container };
    let rows = near(input);
    let positions: Vec<Vec3> = rows.iter().map(|row| walls.inside(input.positions[*row])).collect();
    let free: Vec<f32> = rows.iter().map(|row| input.free[*row]).collect();
    let kernels = kernels::kernels(&positions, &free, input.spacing, &walls);
    if kernels.is_empty() {
        return None;
    }
    let grid = Grid::around(&kernels, input.spacing, &walls);
    let surfels = surfels(input.sponge, input.spacing);
    let (values, away) = density::density(&grid, &kernels, &surfels, input.bodies, input.spacing);
    let films = film::films(&grid, &values, input.sponge, input.spacing);
    let values = film::sink(&grid, values, &away, input.spacing);
    let alone = |kernel: &&Kernel| kernel.company < 0.5;
    let drops = kernels
        .iter()
        .filter(alone)
        .map(|kernel| Drop { centre: kernel.centre, radius: 0.6 * kernel.extent.max_element() });
    let drops = drops.collect();
    Some(Water { field: Field::new(grid, values, input.spacing), drops, films })
}

/// Rows of the particles that are not lost: in an open scene, those near to most of the others.
fn near(input: &Input<'_>) -> Vec<usize> {
    let positions = input.positions;
    let all = 0..positions.len();
    if input.container.is_some() || positions.is_empty() {
        return all.collect();
    }
    let mut middle = Vec3::ZERO;
    for axis in 0..3 {
        let mut places: Vec<f32> = positions.iter().map(|position| position[axis]).collect();
        let half = places.len() / 2;
        middle[axis] = *places.select_nth_unstable_by(half, f32::total_cmp).1;
    }
    let reach = LOST * input.spacing;
    all.filter(|row| (positions[*row] - middle).abs().max_element() < reach).collect()
}
