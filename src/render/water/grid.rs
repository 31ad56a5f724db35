//! The grid that holds the density of the water, around the water only.

use super::bricks::BRICK;
use super::kernels::Kernel;
use super::walls::Walls;
use glam::Vec3;
use std::ops::Range;

/// Side of a cell in spacings.
const CELL: f32 = 0.5;
/// Nodes from the water or the container to the side of the grid.
const MARGIN: f32 = 3.0;
/// Most nodes of a grid; larger scenes get larger cells.
const NODES: f32 = 5e7;
/// Layers of a slab, which one task fills.
pub(super) const SLAB: usize = 4;

/// Places of the nodes of a grid.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Grid {
    /// The node 0, 0, 0 (m).
    pub(in crate::render) origin: Vec3,
    /// Sides of a cell (m).
    pub(in crate::render) cell: Vec3,
    /// One over `cell`.
    pub(in crate::render) inverse: Vec3,
    /// Nodes along each axis; a multiple of eight along x.
    pub(in crate::render) sides: [usize; 3],
    /// The row of nodes along y that is on the floor of a container, if it is on the grid.
    pub(in crate::render) floor: Option<usize>,
}

impl Grid {
    /// A grid around kernels. Walls of a container lie on nodes.
    pub(super) fn around(kernels: &[Kernel], spacing: f32, walls: &Walls) -> Self {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for kernel in kernels {
            low = low.min(kernel.centre - kernel.extent);
            high = high.max(kernel.centre + kernel.extent);
        }
        Self::of_box((low, high), spacing, walls)
    }

    /// A grid around the box of the kernels.
    pub(in crate::render) fn of_box((low, high): (Vec3, Vec3), spacing: f32, walls: &Walls) -> Self {
        let (corner, size) = walls.container.map_or((low, high - low), |(a, b)| (a, b - a));
        let wanted = {
            let extent = if walls.container.is_some() { (high - low).min(size) } else { high - low };
            let nodes = (extent / (CELL * spacing) + 2.0 * MARGIN).element_product();
            CELL * spacing * libm::cbrtf((nodes / NODES).max(1.0))
        };
        let counts = (size / wanted).round().max(Vec3::ONE);
        let cell = size / counts;
        let mut first = ((low - corner) / cell).floor();
        let mut last = ((high - corner) / cell).ceil();
        if walls.container.is_some() {
            first = first.clamp(Vec3::ZERO, counts);
            last = last.clamp(first, counts);
        }
        let (first, last) = (first - MARGIN, last + MARGIN);
        let mut sides = (last - first).to_array().map(|count| count as usize + 1);
        sides[0] = sides[0].next_multiple_of(8);
        let is_floor = walls.container.is_some() && first.y <= 0.0;
        let floor = is_floor.then_some(-first.y as usize);
        Self { origin: corner + cell * first, cell, inverse: cell.recip(), sides, floor }
    }

    /// Bricks along each axis.
    pub(in crate::render) fn bricks(&self) -> [usize; 3] {
        self.sides.map(|nodes| (nodes - 1).div_ceil(BRICK))
    }

    /// Nodes of a layer.
    pub(super) fn layer(&self) -> usize {
        self.sides[0] * self.sides[1]
    }

    /// The mirror image of a node behind the floor, if it is on the grid.
    pub(super) fn mirrored(&self, node: usize) -> Option<usize> {
        let [nx, ny, _] = self.sides;
        let y = node / nx % ny;
        let image = (2 * self.floor?).checked_sub(y).filter(|image| *image < ny)?;
        Some(node - y * nx + image * nx)
    }

    /// Number of slabs.
    pub(super) fn slabs(&self) -> usize {
        self.sides[2].div_ceil(SLAB)
    }

    /// The slabs with nodes nearer to a point than a distance along z.
    pub(super) fn slabs_near(&self, centre: Vec3, reach: f32) -> Range<usize> {
        let first = ((centre.z - reach - self.origin.z) * self.inverse.z).ceil().max(0.0) as usize / SLAB;
        let last = ((centre.z + reach - self.origin.z) * self.inverse.z).floor();
        if last < 0.0 {
            return 0..0;
        }
        first.min(self.slabs())..(last as usize / SLAB + 1).min(self.slabs())
    }

    /// Place of a node (m).
    pub(super) fn node(&self, x: usize, y: usize, z: usize) -> Vec3 {
        self.origin + self.cell * Vec3::new(x as f32, y as f32, z as f32)
    }

    /// The value at a point between nodes, linear; outside of the grid that of its border.
    pub(super) fn between(&self, values: &[f32], point: Vec3) -> f32 {
        let [nx, ny, nz] = self.sides;
        let last = Vec3::new(nx as f32, ny as f32, nz as f32) - 1.001;
        let place = ((point - self.origin) * self.inverse).clamp(Vec3::ZERO, last);
        let [x, y, z] = place.to_array().map(|place| place as usize);
        let f = place - Vec3::new(x as f32, y as f32, z as f32);
        let row = |at: usize| values[at] + (values[at + 1] - values[at]) * f.x;
        let plane = |at: usize| row(at) + (row(at + nx) - row(at)) * f.y;
        let at = (z * ny + y) * nx + x;
        plane(at) + (plane(at + self.layer()) - plane(at)) * f.z
    }

    /// Calls `visit(y, layer of the slab, first x, end of x)` for rows of a slab in a box; the columns are whole eights.
    pub(super) fn rows(
        &self,
        centre: Vec3,
        extent: Vec3,
        layers: Range<usize>,
        mut visit: impl FnMut(usize, usize, usize, usize),
    ) {
        let low =
            ((centre - extent - self.origin) * self.inverse).to_array().map(|node| node.max(0.0) as usize);
        let high = ((centre + extent - self.origin) * self.inverse).to_array();
        if high.iter().any(|node| *node < 0.0) {
            return;
        }
        let end = high.map(|node| node as usize + 1);
        let columns = (low[0] / 8 * 8, end[0].next_multiple_of(8).min(self.sides[0]));
        if columns.0 >= columns.1 {
            return;
        }
        for z in low[2].max(layers.start)..end[2].min(layers.end) {
            for y in low[1]..end[1].min(self.sides[1]) {
                visit(y, z - layers.start, columns.0, columns.1);
            }
        }
    }
}
