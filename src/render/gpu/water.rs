//! The surface of the free water on the device: which particles are free, their kernels, and the density on a grid.

use glam::Vec3;
use sorb_kernels::gpu::GpuError;

use super::passes::{Work, groups_of, two_dimensional};
use super::read::Bounds;
use super::scene::{FAR_AWAY, Scene};
use super::{Renderer, mesh};
use crate::render::{
    stage::Stage,
    water::{Grid, LOST, REACH, Walls, surfels},
};

/// Most cells of the search for neighbours.
const CELLS: f32 = 8e6;

impl Renderer {
    /// Uploads the pieces of the surface of the sponges.
    pub(super) fn upload_surfels(&mut self, stage: &Stage<'_>, scene: &mut Scene) -> Result<(), GpuError> {
        let spacing = scene.spacing;
        let pieces = if spacing > 0.0 { surfels(&stage.sponge, spacing) } else { Vec::new() };
        let (cells, rows) = mesh::surfels(&pieces, 0.5 * REACH * spacing.max(1e-6));
        let table = cells.table();
        scene.surfels = pieces.len() as u32;
        (scene.surfel_low, scene.surfel_inverse) = (table.low, table.inverse);
        scene.surfel_sides = table.sides.map(|side| side as u32);
        self.buffers.write("surfel_cells", bytemuck::cast_slice(table.start))?;
        self.buffers.write("surfels", bytemuck::cast_slice(&rows))
    }

    /// Room for what every particle has.
    pub(super) fn reserve_particles(&mut self, scene: &Scene) -> Result<(), GpuError> {
        let count = u64::from(scene.particles);
        self.buffers.reserve("free", 4 * count)?;
        self.buffers.reserve("points", 16 * count)
    }

    /// Room for points in cells and their list.
    pub(super) fn reserve_cells(&mut self, scene: &Scene, entries: u64) -> Result<(), GpuError> {
        self.buffers.reserve("counts", 4 * u64::from(scene.cell_count))?;
        self.buffers.reserve("page_sums", 4 * u64::from(scene.cell_pages))?;
        self.buffers.reserve("cells", 4 * (u64::from(scene.cell_list) + entries))
    }

    /// Cells around the particles, and room for their kernels.
    pub(super) fn prepare_kernels(
        &mut self,
        scene: &mut Scene,
        around: (Vec3, Vec3),
    ) -> Result<(), GpuError> {
        scene.set_cells(around, 0.5 * REACH * scene.spacing, scene.particles, 1, CELLS);
        let count = u64::from(scene.particles);
        self.reserve_cells(scene, count)?;
        self.buffers.reserve("kernels", 64 * count)
    }

    /// The grid around all kernels, and room for what its nodes and bricks have.
    pub(super) fn prepare_grid(
        &mut self,
        scene: &mut Scene,
        stage: &Stage<'_>,
        kernels: Bounds,
    ) -> Result<(), GpuError> {
        let grid = Grid::of_box(kernels, scene.spacing, &Walls { container: stage.container });
        scene.set_grid(&grid);
        let nodes = 4 * scene.field_nodes();
        for name in ["sums", "densities"] {
            self.buffers.reserve(name, nodes)?;
        }
        let of_sponge = if scene.surfels > 0 { nodes } else { 0 };
        for name in ["away", "sunk"] {
            self.buffers.reserve(name, of_sponge)?;
        }
        for name in ["bricks", "other_bricks"] {
            self.buffers.reserve(name, 4 * scene.bricks())?;
        }
        for (axis, name) in [(0, "axis_x"), (1, "axis_y"), (2, "axis_z")] {
            self.buffers.write_uniform(name, &[axis, 0, 0, 0])?;
        }
        Ok(())
    }
}

/// Distance from the middle of an open scene from which on particles are lost (m).
pub(super) fn lost(stage: &Stage<'_>) -> f32 {
    if stage.container.is_some() { FAR_AWAY } else { 2.0 * LOST * stage.radius }
}

/// How much of each particle is free water.
pub(super) fn pores(work: &mut Work<'_>, scene: &Scene) -> Result<(), GpuError> {
    let interior = if scene.has_interior == 0 { "nothing" } else { "interior" };
    work.run("render::pores", &[("interior", interior)], groups_of(u64::from(scene.particles)))
}

/// Points sorted into cells. `points` is the buffer that they are in.
pub(super) fn cells(work: &mut Work<'_>, scene: &Scene, points: &'static str) -> Result<(), GpuError> {
    let (rows, pages) = (groups_of(u64::from(scene.points)), two_dimensional(u64::from(scene.cell_pages)));
    work.run("render::cells_count", &[("points", points)], rows)?;
    work.run("render::cells_sums", &[], pages)?;
    work.run("render::cells_pages", &[], [1, 1])?;
    work.run("render::cells_starts", &[], pages)?;
    work.run("render::cells_list", &[("points", points)], rows)
}

/// Kernels of the free particles.
pub(super) fn kernels(work: &mut Work<'_>, scene: &Scene) -> Result<(), GpuError> {
    cells(work, scene, "points")?;
    work.run("render::cells_order", &[], groups_of(u64::from(scene.cell_count)))?;
    work.run("render::kernels", &[], groups_of(u64::from(scene.particles)))
}

/// The density of the water on the grid, and its bricks.
pub(super) fn field(work: &mut Work<'_>, scene: &Scene) -> Result<(), GpuError> {
    let nodes = groups_of(scene.field_nodes());
    work.clear("sums", 4 * scene.field_nodes());
    work.run("render::density", &[], two_dimensional(u64::from(scene.particles)))?;
    if scene.surfels > 0 {
        work.run("render::distances", &[], nodes)?;
    }
    work.run("render::closure", &[], nodes)?;
    if scene.surfels > 0 {
        work.run("render::film", &[], nodes)?;
        work.run("render::films", &[], groups_of(u64::from(scene.nodes)))?;
    }
    let bricks = groups_of(scene.bricks());
    work.run("render::bricks", &[("densities", densities(scene))], bricks)?;
    for (axis, before, after) in [
        ("axis_x", "bricks", "other_bricks"),
        ("axis_y", "other_bricks", "bricks"),
        ("axis_z", "bricks", SKIPS),
    ] {
        work.run("render::skips", &[("axis", axis), ("before", before), ("bricks", after)], bricks)?;
    }
    Ok(())
}

/// Where the bricks with their skips are.
pub(super) const SKIPS: &str = "other_bricks";

/// Where the densities that rays see are: where there is a sponge, after the surface has sunk.
pub(super) fn densities(scene: &Scene) -> &'static str {
    if scene.surfels > 0 { "sunk" } else { "densities" }
}
