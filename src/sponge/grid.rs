//! The dense lattice of one sponge during set-up: which tets exist, and the row of every site.

use glam::DVec3;

use super::class::{CLASS_OFFSET, TET_CLASS_COUNT, doubled};
use super::error::LatticeError;
use super::lattice::LatticeSponge;
use super::pits::Pits;

/// Row of a site that no tet touches.
pub(super) const NO_NODE: u32 = u32::MAX;

const ALL_CLASSES: u16 = (1 << TET_CLASS_COUNT) - 1;

/// One sponge on its dense lattice.
///
/// The cells of tets run over `0..=n` on each axis, like the sites of A: a tet belongs to the cell of its first A node.
pub(super) struct Grid {
    pub(super) cells: [u32; 3],
    /// Bit `class` of each cell: the tet exists.
    present: Vec<u16>,
    /// First the number of tets at each site, then its row or `NO_NODE`; sublattices A and B.
    sites: [Vec<u32>; 2],
    pub(super) tet_count: u32,
    pub(super) node_count: u32,
    pub(super) pits: Pits,
    candidates: u32,
}

impl Grid {
    /// Evaluates the mask of a checked sponge once for every tet, and counts tets at the sites.
    pub(super) fn new(index: usize, sponge: &LatticeSponge<'_>) -> Result<Self, LatticeError> {
        let cells = sponge.cells;
        let [corners, centres] = [1, 0].map(|more| cells.iter().map(|&n| n as usize + more).product());
        let mut grid = Self {
            cells,
            present: vec![0; corners],
            sites: [vec![0; corners], vec![0; centres]],
            tet_count: 0,
            node_count: 0,
            pits: Pits::default(),
            candidates: 0,
        };
        grid.select(sponge);
        if grid.tet_count == 0 && !sponge.may_be_empty {
            return Err(LatticeError::Empty { sponge: index, cells, candidates: grid.candidates });
        }
        grid.node_count = grid.sites.iter().flatten().map(|&count| u32::from(count > 0)).sum();
        grid.pits = Pits::new(&grid, sponge);
        Ok(grid)
    }

    fn select(&mut self, sponge: &LatticeSponge<'_>) {
        // Eight times the offset of the centroid from its cell, in edges: sums of small integers are exact.
        let nodes: [_; TET_CLASS_COUNT] = std::array::from_fn(doubled);
        let extent = self.cells.map(|n| 8.0 * f64::from(n));
        let [nx, ny, nz] = self.cells;
        let deltas = self.deltas();
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let [corner, centre] = self.bases([i, j, k]);
                    let inside = self.inside([i, j, k]);
                    self.candidates += inside.count_ones();
                    for class in classes(inside) {
                        let middle = [i, j, k].map(|index| 8.0 * f64::from(index));
                        let place = |eighths: [i32; 3]| {
                            let unit = |axis: usize| (middle[axis] + f64::from(eighths[axis])) / extent[axis];
                            DVec3::new(unit(0), unit(1), unit(2)).as_vec3()
                        };
                        let centroid = [0, 1, 2].map(|axis| nodes[class].iter().map(|node| node[axis]).sum());
                        let has_room = |node: &[i32; 3]| (sponge.has_room)(place(node.map(|half| 4 * half)));
                        if !(sponge.keep)(place(centroid)) || !nodes[class].iter().all(has_room) {
                            continue;
                        }
                        self.present[corner] |= 1 << class;
                        self.tet_count += 1;
                        for (slot, delta) in deltas[class].iter().enumerate() {
                            let base = if slot < 2 { corner } else { centre };
                            self.sites[slot / 2][base.wrapping_add_signed(*delta)] += 1;
                        }
                    }
                }
            }
        }
    }

    /// Classes whose tet at a cell lies wholly inside the block.
    fn inside(&self, cell: [u32; 3]) -> u16 {
        if (0..3).all(|axis| cell[axis] >= 1 && cell[axis] < self.cells[axis]) {
            return ALL_CLASSES;
        }
        let fits = |class: usize| {
            CLASS_OFFSET[class].iter().enumerate().all(|(slot, offset)| {
                (0..3).all(|axis| {
                    let index = i64::from(cell[axis]) + i64::from(offset[axis]);
                    let sites = i64::from(self.cells[axis]) + i64::from(slot < 2);
                    (0..sites).contains(&index)
                })
            })
        };
        (0..TET_CLASS_COUNT).fold(0, |mask, class| mask | u16::from(fits(class)) << class)
    }

    /// Distances from the base of a cell to the four nodes of each class, in their sublattices.
    pub(super) fn deltas(&self) -> [[isize; 4]; TET_CLASS_COUNT] {
        let [nx, ny, _] = self.cells.map(|n| n as isize);
        std::array::from_fn(|class| {
            std::array::from_fn(|slot| {
                let more = isize::from(slot < 2);
                let [i, j, k] = CLASS_OFFSET[class][slot].map(|offset| offset as isize);
                (k * (ny + more) + j) * (nx + more) + i
            })
        })
    }

    /// Indices of a cell in the sublattices A and B; the latter may lie outside until an offset is added.
    pub(super) fn bases(&self, cell: [u32; 3]) -> [usize; 2] {
        let [i, j, k] = cell.map(|index| index as usize);
        let [nx, ny, _] = self.cells.map(|n| n as usize);
        [(k * (ny + 1) + j) * (nx + 1) + i, (k * ny + j) * nx + i]
    }

    /// Rows of the nodes of a tet, once the sites are numbered.
    pub(super) fn nodes(&self, bases: [usize; 2], deltas: &[isize; 4]) -> [u32; 4] {
        std::array::from_fn(|slot| self.sites[slot / 2][bases[slot / 2].wrapping_add_signed(deltas[slot])])
    }

    /// Existing classes at a cell.
    pub(super) fn present(&self, corner: usize) -> u16 {
        self.present[corner]
    }

    /// Whether a tet exists; false outside the lattice.
    pub(super) fn has(&self, cell: [i64; 3], class: usize) -> bool {
        let inside = (0..3).all(|axis| (0..=i64::from(self.cells[axis])).contains(&cell[axis]));
        if !inside {
            return false;
        }
        let [i, j, k] = cell;
        let [nx, ny] = [self.cells[0], self.cells[1]].map(|n| i64::from(n) + 1);
        usize::try_from((k * ny + j) * nx + i).is_ok_and(|corner| self.present[corner] >> class & 1 == 1)
    }

    /// Index of a cell of the lattice.
    pub(super) fn corner(&self, cell: [i64; 3]) -> usize {
        self.bases(cell.map(|index| index as u32))[0]
    }

    /// Whether a site, given in units of half an edge, lies in the block.
    pub(super) fn is_inside(&self, site: [i32; 3]) -> bool {
        (0..3).all(|axis| (0..=2 * i64::from(self.cells[axis])).contains(&i64::from(site[axis])))
    }

    /// Number of tets at a site inside, given in units of half an edge, before the sites are numbered.
    pub(super) fn count(&self, site: [i32; 3]) -> u32 {
        let sublattice = site[0].rem_euclid(2) as usize;
        let [i, j, k] = site.map(|half| half as usize / 2);
        let [nx, ny, _] = self.cells.map(|n| n as usize + 1 - sublattice);
        self.sites[sublattice][(k * ny + j) * nx + i]
    }

    /// Every cell that lacks tets, with their classes, in the order k, j, i.
    pub(super) fn absent(&self) -> impl Iterator<Item = ([i64; 3], impl Iterator<Item = usize>)> {
        let [nx, ny, _] = self.cells.map(|n| n as usize + 1);
        let lacking = self.present.iter().enumerate().filter(|(_, present)| **present != ALL_CLASSES);
        lacking.map(move |(corner, present)| {
            let cell = [corner % nx, corner / nx % ny, corner / (nx * ny)].map(|index| index as i64);
            (cell, classes(!present & ALL_CLASSES))
        })
    }

    /// Numbers the sites of one vertex colour from `next` on, in the order k, j, i. Calls `node` for each site in use with
    /// its indices, its number of tets, and its volume of pits over that of a tet.
    pub(super) fn number(&mut self, color: u32, next: &mut u32, mut node: impl FnMut([u32; 3], u32, f64)) {
        let [sublattice, parity] = [color / 2, color % 2];
        let [nx, ny, nz] = self.cells.map(|n| n + 1 - sublattice);
        let (sites, pits) = (&mut self.sites[sublattice as usize], &self.pits);
        for k in 0..nz {
            for j in 0..ny {
                let row = (k as usize * ny as usize + j as usize) * nx as usize;
                for i in ((parity + j + k) % 2..nx).step_by(2) {
                    let site = &mut sites[row + i as usize];
                    let count = std::mem::replace(site, NO_NODE);
                    if count > 0 {
                        *site = *next;
                        *next += 1;
                        node([i, j, k], count, pits.of_node(sublattice, [i, j, k]));
                    }
                }
            }
        }
    }
}

/// The classes of a set of bits, in rising order.
pub(super) fn classes(mask: u16) -> impl Iterator<Item = usize> {
    let mut rest = mask;
    std::iter::from_fn(move || {
        (rest != 0).then(|| {
            let class = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            class
        })
    })
}
