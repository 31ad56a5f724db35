//! Pits: volume between the faces of a sponge and its lattice that no tet fills.
//!
//! A tet with one node outside of the block is left out, and half of it lies inside. This half lies between its other nodes
//! and the middle of the long edge to the missing node. That middle is in the face of the block. Four such halves around one edge are a
//! pit: the pyramid between a square of the face and the node below it, of volume `a^3/6`. All pits are what a block lacks of its box.
//! Where a node is missing because a body occupies its place, the same halves count if there is room for the middle of the edge.
//!
//! A half belongs to the tet behind its inner face, which then stands for more than its own volume. Where there is none, as at the edges of
//! a box, it belongs to all tets with a face on the same pit. If there are none either, it belongs to all tets at the node below it. Its
//! mass belongs to its own corners: a quarter each, and that of the middle of the edge to the corners of the square.
//!
//! Where a mask ends a sponge only the halves that the mask keeps count. There a tet belongs to the shape by its centroid,
//! so that on average as much sticks out as is missing.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

use super::class::{CLASS_OFFSET, TET_CLASS_COUNT, doubled};
use super::grid::Grid;
use super::lattice::LatticeSponge;
use super::surface::Surface;

/// The other slot of the long edge of every slot.
const PARTNER: [usize; 4] = [1, 0, 3, 2];

/// Coordinates of a site in units of half an edge: even ones are of sublattice A.
type Site = [i32; 3];

/// Additional volume of tets and nodes beyond the tets themselves, over the volume of a tet.
#[derive(Default)]
pub(super) struct Pits {
    /// By the index of the cell and the class.
    tets: BTreeMap<(usize, usize), f64>,
    /// By the site.
    nodes: BTreeMap<Site, f64>,
    /// The sum.
    pub(super) volume: f64,
}

/// A half of a tet that does not exist: its cell, its class, and the slot of the node that is missing.
struct Half {
    cell: [i64; 3],
    class: usize,
    missing: usize,
    nodes: [Site; 4],
}

impl Pits {
    /// The pits of a sponge whose tets are known.
    pub(super) fn new(grid: &Grid, sponge: &LatticeSponge<'_>) -> Self {
        let (surface, mut pits) = (Surface::new(), Self::default());
        for halves in halves(grid, sponge).values() {
            pits.add_to_tets(grid, &surface, halves);
            pits.add_to_nodes(grid, halves);
            pits.volume += 0.5 * halves.len() as f64;
        }
        pits
    }

    /// Additional volume of a tet, over its own.
    pub(super) fn of_tet(&self, corner: usize, class: usize) -> f64 {
        self.tets.get(&(corner, class)).copied().unwrap_or(0.0)
    }

    /// Additional volume of a node beyond a quarter of its tets, over the volume of a tet.
    pub(super) fn of_node(&self, sublattice: u32, site: [u32; 3]) -> f64 {
        let site = site.map(|index| 2 * index.cast_signed() + sublattice.cast_signed());
        self.nodes.get(&site).copied().unwrap_or(0.0)
    }

    fn add_to_tets(&mut self, grid: &Grid, surface: &Surface, halves: &[Half]) {
        let behind: Vec<_> = halves
            .iter()
            .filter_map(|half| {
                let (cell, class) = surface.behind(half.cell, half.class, half.missing);
                grid.has(cell, class).then(|| (grid.corner(cell), class))
            })
            .collect();
        let others = if behind.is_empty() { tets_at(grid, halves[0].below()) } else { behind.clone() };
        let left = 0.5 * (halves.len() - behind.len()) as f64 / others.len() as f64;
        behind.into_iter().for_each(|tet| *self.tets.entry(tet).or_default() += 0.5);
        others.into_iter().for_each(|tet| *self.tets.entry(tet).or_default() += left);
    }

    fn add_to_nodes(&mut self, grid: &Grid, halves: &[Half]) {
        let below = halves[0].below();
        let mut ring: Vec<Site> = halves.iter().flat_map(Half::rim).collect();
        ring.sort_unstable();
        ring.dedup();
        ring.retain(|site| grid.count(*site) > 0);
        // The part of the middle of the square, or of a site without tets, is shared by its corners.
        let quarter = 0.125;
        let mut shared = 0.0;
        for half in halves {
            *self.nodes.entry(below).or_default() += quarter;
            shared += quarter;
            for site in half.rim() {
                if grid.count(site) > 0 {
                    *self.nodes.entry(site).or_default() += quarter;
                } else {
                    shared += quarter;
                }
            }
        }
        if ring.is_empty() {
            ring.push(below);
        }
        let share = shared / ring.len() as f64;
        ring.into_iter().for_each(|site| *self.nodes.entry(site).or_default() += share);
    }
}

impl Half {
    /// The node below the square.
    fn below(&self) -> Site {
        self.nodes[PARTNER[self.missing]]
    }

    /// Its two corners of the square.
    fn rim(&self) -> [Site; 2] {
        let first = if self.missing < 2 { 2 } else { 0 };
        [self.nodes[first], self.nodes[first + 1]]
    }
}

/// All halves that belong to the shape, by the edge that they lie around.
fn halves(grid: &Grid, sponge: &LatticeSponge<'_>) -> BTreeMap<[Site; 2], Vec<Half>> {
    let shapes: [[Site; 4]; TET_CLASS_COUNT] = std::array::from_fn(doubled);
    let extent = DVec3::from_array(grid.cells.map(|n| 2.0 * f64::from(n)));
    let place = |site: DVec3| -> Vec3 { (site / extent).as_vec3() };
    let has_room = |site: Site| (sponge.has_room)(place(exact(site)));
    let is_there = |site: Site| grid.is_inside(site) && has_room(site);
    let mut pits = BTreeMap::<_, Vec<Half>>::new();
    for (cell, absent) in grid.absent() {
        for class in absent {
            let nodes = shapes[class].map(|node| [0, 1, 2].map(|axis| node[axis] + 2 * cell[axis] as i32));
            let mut missing = (0..4).filter(|slot| !is_there(nodes[*slot]));
            let (Some(slot), None) = (missing.next(), missing.next()) else { continue };
            let half = Half { cell, class, missing: slot, nodes };
            let (below, beyond) = (half.below(), nodes[slot]);
            let middle = [0, 1, 2].map(|axis| i32::midpoint(below[axis], beyond[axis]));
            let [a, b] = half.rim();
            let centroid = (exact(below) + exact(middle) + exact(a) + exact(b)) * 0.25;
            if grid.count(below) > 0 && has_room(middle) && (sponge.keep)(place(centroid)) {
                pits.entry([below, beyond]).or_default().push(half);
            }
        }
    }
    pits
}

fn exact(site: Site) -> DVec3 {
    DVec3::from_array(site.map(f64::from))
}

/// The tets at a site.
fn tets_at(grid: &Grid, site: Site) -> Vec<(usize, usize)> {
    let odd = site[0].rem_euclid(2);
    let first = 2 * odd as usize;
    let mut tets = Vec::new();
    for (class, offsets) in CLASS_OFFSET.iter().enumerate() {
        for offset in &offsets[first..first + 2] {
            let cell = [0, 1, 2].map(|axis| i64::from((site[axis] - odd) / 2 - offset[axis]));
            if grid.has(cell, class) {
                tets.push((grid.corner(cell), class));
            }
        }
    }
    tets
}
