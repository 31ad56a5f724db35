//! All sponges in one packed lattice.

use std::fmt;
use std::ops::Range;

use glam::{DVec3, Vec3};

use super::class::{COLORS, VERTEX_COLORS};
use super::error::LatticeError;
use super::grid::Grid;
use super::limits::check;
use super::surface::Surface;

/// A sponge to set up: a block of cells and the shape cut out of it.
#[derive(Clone, Copy)]
pub struct LatticeSponge<'a> {
    /// Edge of a cubic cell, the lattice constant \[m\]; from [`MIN_EDGE`](super::MIN_EDGE) to
    /// [`MAX_EDGE`](super::MAX_EDGE).
    pub edge: f32,
    /// Cells along x, y and z; each at least 1; all sponges together at most [`MAX_CELLS`](super::MAX_CELLS).
    pub cells: [u32; 3],
    /// Minimum corner of the block in the world \[m\]; finite, within `2^17` edges of the world's origin.
    pub origin: Vec3,
    /// Whether a tet belongs to the shape, given its centroid in the unit cube of the block. Called once for each tet, and
    /// once for each half of a tet that the end of the block cuts through.
    pub keep: &'a dyn Fn(Vec3) -> bool,
    /// Whether there is room for a node at a place in the unit cube of the block. Tets with a node elsewhere are left out.
    pub has_room: &'a dyn Fn(Vec3) -> bool,
    /// Whether there may be no tets at all.
    pub may_be_empty: bool,
}

impl fmt::Debug for LatticeSponge<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("LatticeSponge")
            .field("edge", &self.edge)
            .field("cells", &self.cells)
            .field("origin", &self.origin)
            .finish_non_exhaustive()
    }
}

/// Summary of one sponge.
#[derive(Clone, Debug, PartialEq)]
pub struct SpongeSummary {
    /// Edge of its cells \[m\].
    pub edge: f32,
    /// Number of nodes.
    pub node_count: u32,
    /// Number of tets.
    pub tet_count: u32,
    /// Its triangles, which are contiguous.
    pub triangles: Range<u32>,
    /// Volume at rest \[m^3\], pores included: its tets with their [weights](Lattice::tet_weight). A whole block has the
    /// volume of its box.
    pub rest_volume: f64,
}

/// The packed lattice of all sponges, in the order of rows of the [module](super).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lattice {
    /// Position of each node at rest \[m\]; the fourth entry is left at 0 for the inverse mass.
    pub position: Vec<[f32; 4]>,
    /// Sponge of each node.
    pub node_sponge: Vec<u32>,
    /// Number of tets at each node: 1 to 24, and 24 inside.
    pub node_tet_count: Vec<u32>,
    /// Volume that each node stands for \[m^3\]: a quarter of each of its tets, and its share of pits in the faces. The sum
    /// is the volume of the sponge.
    pub node_volume: Vec<f32>,
    /// Whether the node lies on the outer surface.
    pub node_surface: Vec<bool>,
    /// First node of each vertex colour (A even, A odd, B even, B odd), then the number of nodes.
    pub vertex_color_start: [u32; VERTEX_COLORS + 1],
    /// Nodes of each tet, positively oriented, in the slots of [`CLASS_OFFSET`](super::CLASS_OFFSET).
    pub tets: Vec<[u32; 4]>,
    /// Volume that each tet stands for over its own \[1\]: 1 inside, 2 in the face of a block, more at its edges. Its
    /// elastic energy and its pores count with that volume, at the strain of the tet.
    pub tet_weight: Vec<f32>,
    /// First tet of each colour (`class * 2 + parity`), then the number of tets.
    pub color_start: [u32; COLORS + 1],
    /// Sponge of each tet.
    pub tet_sponge: Vec<u32>,
    /// Slab of each tet: the lattice index k of its cell.
    pub tet_slab: Vec<u32>,
    /// Outer surface: nodes of each face that belongs to one tet only, wound outwards; by sponge.
    pub triangles: Vec<[u32; 3]>,
    /// Sponge of each triangle.
    pub triangle_sponge: Vec<u32>,
    /// One summary for each sponge, in the order given.
    pub sponges: Vec<SpongeSummary>,
}

impl Lattice {
    /// Sets up sponges. The same list always gives the same lattice, and no sponges give an empty one.
    ///
    /// A mask may leave a sponge in several pieces, see [`pieces`](super::pieces).
    ///
    /// # Errors
    ///
    /// [`LatticeError`] names the first sponge with a bad edge, number of cells or origin, with no tets, or with
    /// more cells than allowed.
    pub fn new(sponges: &[LatticeSponge<'_>]) -> Result<Self, LatticeError> {
        check(sponges)?;
        let grids = sponges.iter().enumerate().map(|(index, sponge)| Grid::new(index, sponge));
        let mut grids = grids.collect::<Result<Vec<_>, _>>()?;
        let mut lattice =
            Self { sponges: sponges.iter().zip(&grids).map(summary).collect(), ..Self::default() };
        lattice.add_nodes(sponges, &mut grids);
        lattice.add_tets(&grids);
        lattice.add_triangles(&grids);
        Ok(lattice)
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.position.len()
    }

    /// Number of tets.
    #[must_use]
    pub fn tet_count(&self) -> usize {
        self.tets.len()
    }

    /// Nodes of one vertex colour (0 to 3) of one sponge; empty where there are none.
    #[must_use]
    pub fn node_range(&self, vertex_color: usize, sponge: u32) -> Range<u32> {
        sponge_range(&self.node_sponge, &self.vertex_color_start, vertex_color, sponge)
    }

    /// Tets of one colour (0 to 23) of one sponge; empty where there are none.
    #[must_use]
    pub fn tet_range(&self, color: usize, sponge: u32) -> Range<u32> {
        sponge_range(&self.tet_sponge, &self.color_start, color, sponge)
    }

    /// Volume of a sponge at rest \[m^3\], pores included; `None` if there is no such sponge.
    #[must_use]
    pub fn rest_volume(&self, sponge: u32) -> Option<f64> {
        self.sponges.get(sponge as usize).map(|summary| summary.rest_volume)
    }

    fn add_nodes(&mut self, sponges: &[LatticeSponge<'_>], grids: &mut [Grid]) {
        let count = grids.iter().map(|grid| grid.node_count as usize).sum();
        self.position.reserve_exact(count);
        self.node_sponge.reserve_exact(count);
        self.node_tet_count.reserve_exact(count);
        self.node_volume.reserve_exact(count);
        let mut next = 0;
        for color in 0..4 {
            for ((index, sponge), grid) in (0..).zip(sponges).zip(grids.iter_mut()) {
                let half_edge = 0.5 * f64::from(sponge.edge);
                let tet = tet_volume(sponge.edge);
                let origin = sponge.origin.as_dvec3();
                let shift = if color < 2 { 0.0 } else { 1.0 };
                grid.number(color, &mut next, |site, tet_count, of_pits| {
                    // Rounded once, from an exact site, so that rest lengths are as equal as possible.
                    let doubled = DVec3::from_array(site.map(|index| 2.0 * f64::from(index) + shift));
                    let place = (origin + half_edge * doubled).as_vec3();
                    self.position.push([place.x, place.y, place.z, 0.0]);
                    self.node_sponge.push(index);
                    self.node_tet_count.push(tet_count);
                    self.node_volume.push(rounded(tet * (0.25 * f64::from(tet_count) + of_pits)));
                });
            }
            self.vertex_color_start[color as usize + 1] = next;
        }
    }

    fn add_tets(&mut self, grids: &[Grid]) {
        let count = grids.iter().map(|grid| grid.tet_count as usize).sum();
        self.tets.reserve_exact(count);
        self.tet_sponge.reserve_exact(count);
        self.tet_slab.reserve_exact(count);
        self.tet_weight.reserve_exact(count);
        let mut next = 0;
        for color in 0..COLORS {
            let [class, odd] = [color / 2, color % 2];
            for (index, grid) in (0..).zip(grids) {
                let deltas = grid.deltas()[class];
                let [nx, ny, nz] = grid.cells;
                for k in 0..=nz {
                    for j in 0..=ny {
                        let first = (u32::from(odd == 1) + j + k) % 2;
                        for i in (first..=nx).step_by(2) {
                            let bases = grid.bases([i, j, k]);
                            if grid.present(bases[0]) >> class & 1 == 1 {
                                self.tets.push(grid.nodes(bases, &deltas));
                                self.tet_sponge.push(index);
                                self.tet_slab.push(k);
                                self.tet_weight.push(rounded(1.0 + grid.pits.of_tet(bases[0], class)));
                                next += 1;
                            }
                        }
                    }
                }
            }
            self.color_start[color + 1] = next;
        }
    }

    fn add_triangles(&mut self, grids: &[Grid]) {
        let surface = Surface::new();
        self.node_surface = vec![false; self.position.len()];
        let mut next = 0;
        for ((index, summary), grid) in (0..).zip(&mut self.sponges).zip(grids) {
            let first = next;
            surface.triangles(grid, |triangle| {
                for node in triangle {
                    self.node_surface[node as usize] = true;
                }
                self.triangles.push(triangle);
                self.triangle_sponge.push(index);
                next += 1;
            });
            summary.triangles = first..next;
        }
    }
}

fn summary((sponge, grid): (&LatticeSponge<'_>, &Grid)) -> SpongeSummary {
    SpongeSummary {
        edge: sponge.edge,
        node_count: grid.node_count,
        tet_count: grid.tet_count,
        triangles: 0..0,
        rest_volume: (f64::from(grid.tet_count) + grid.pits.volume) * tet_volume(sponge.edge),
    }
}

fn tet_volume(edge: f32) -> f64 {
    let edge = f64::from(edge);
    edge * edge * edge / 12.0
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the precision of the state is the purpose")]
fn rounded(value: f64) -> f32 {
    value as f32
}

fn sponge_range(owner: &[u32], starts: &[u32], color: usize, sponge: u32) -> Range<u32> {
    let (Some(&start), Some(&end)) = (starts.get(color), starts.get(color + 1)) else {
        return 0..0;
    };
    let first = first_after(start..end, |row| owner[row as usize] < sponge);
    first..first_after(first..end, |row| owner[row as usize] == sponge)
}

/// First row of a range that does not belong; those that do come first.
pub(super) fn first_after(rows: Range<u32>, belongs: impl Fn(u32) -> bool) -> u32 {
    let Range { start: mut low, end: mut high } = rows;
    while low < high {
        let middle = low + (high - low) / 2;
        if belongs(middle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low
}
