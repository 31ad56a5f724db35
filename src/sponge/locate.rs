//! Points in sponges: which tet holds a point, and where in it.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3, Vec3};

/// How far outside of a tet a point may lie to count as in it, over its size. Points on faces between tets are in one of them.
const TOLERANCE: f64 = 1e-6;

/// Cells that a tet may meet, else it is asked for every point: nothing but a torn sponge has larger ones.
const MOST_CELLS: i64 = 4096;

/// The tets near some box, by cells.
#[derive(Clone, Debug)]
pub(crate) struct TetGrid<'a> {
    nodes: &'a [[f32; 4]],
    tets: &'a [[u32; 4]],
    cell: f32,
    cells: BTreeMap<[i64; 3], Vec<u32>>,
    large: Vec<u32>,
}

/// A tet, and the weights of its nodes at a point, which sum to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Located {
    pub(crate) tet: u32,
    pub(crate) weights: [f32; 4],
}

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

impl<'a> TetGrid<'a> {
    /// Of the tets whose boxes meet a box, in cells of some edge \[m\].
    pub(crate) fn new(
        (nodes, tets): (&'a [[f32; 4]], &'a [[u32; 4]]),
        (low, high): (Vec3, Vec3),
        cell: f32,
    ) -> Self {
        let mut grid = Self { nodes, tets, cell, cells: BTreeMap::new(), large: Vec::new() };
        for (index, tet) in tets.iter().enumerate() {
            let corners = tet.map(|node| place(&nodes[node as usize]));
            let (mut own_low, mut own_high) = (corners[0], corners[0]);
            for corner in &corners[1..] {
                (own_low, own_high) = (own_low.min(*corner), own_high.max(*corner));
            }
            let is_near = own_low.cmple(high).all() && own_high.cmpge(low).all();
            if is_near {
                grid.insert(index as u32, own_low.max(low), own_high.min(high));
            }
        }
        grid
    }

    fn insert(&mut self, tet: u32, low: Vec3, high: Vec3) {
        let (first, last) = (self.cell_of(low), self.cell_of(high));
        let lengths = [0, 1, 2].map(|axis| last[axis] - first[axis] + 1);
        let count = lengths.iter().fold(1_i64, |count, length| count.saturating_mul(*length));
        if count > MOST_CELLS {
            self.large.push(tet);
            return;
        }
        for x in first[0]..=last[0] {
            for y in first[1]..=last[1] {
                for z in first[2]..=last[2] {
                    self.cells.entry([x, y, z]).or_default().push(tet);
                }
            }
        }
    }

    fn cell_of(&self, point: Vec3) -> [i64; 3] {
        (point / self.cell).floor().to_array().map(|cell| cell as i64)
    }

    /// The tet that holds a point; the first of several.
    pub(crate) fn find(&self, point: Vec3) -> Option<Located> {
        let near = self.cells.get(&self.cell_of(point)).into_iter().flatten();
        near.chain(&self.large).find_map(|tet| self.weights(*tet, point))
    }

    /// The weights of the nodes of a tet at a point in it.
    fn weights(&self, tet: u32, point: Vec3) -> Option<Located> {
        let nodes = self.tets[tet as usize];
        let [a, b, c, d] = nodes.map(|node| place(&self.nodes[node as usize]).as_dvec3());
        let edges = DMat3::from_cols(b - a, c - a, d - a);
        // A flat tet holds nothing.
        let [x, y, z] = edges.try_inverse()?.mul_vec3(point.as_dvec3() - a).to_array();
        let weights = [1.0 - x - y - z, x, y, z];
        let is_in = DVec3::new(x, y, z).is_finite() && weights.iter().all(|weight| *weight >= -TOLERANCE);
        is_in.then(|| Located { tet, weights: weights.map(|weight| weight as f32) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sponge::{Lattice, LatticeSponge, block};

    #[test]
    fn points_in_a_block_are_in_its_tets_and_others_are_not() {
        let sponge = LatticeSponge {
            edge: 0.01,
            cells: [4, 3, 5],
            origin: Vec3::new(-0.3, 0.2, 0.0),
            keep: &block,
            has_room: &|_| true,
            may_be_empty: false,
        };
        let lattice = Lattice::new(&[sponge]).unwrap_or_else(|error| panic!("{error}"));
        let size = Vec3::new(0.04, 0.03, 0.05);
        let (low, high) = (sponge.origin - size, sponge.origin + 2.0 * size);
        let grid = TetGrid::new((&lattice.position, &lattice.tets), (low, high), 0.01);
        let (mut inside, mut missed, mut count) = (0, 0, 0);
        for step in 0..8000_u32 {
            let unit = Vec3::new((step % 20) as f32, (step / 20 % 20) as f32, (step / 400) as f32) / 20.0;
            let point = low + unit * (high - low);
            let relative = (point - sponge.origin) / size;
            // Faces of a block are rough by pits of half a cell.
            let is_deep = relative.cmpgt(Vec3::splat(0.2)).all() && relative.cmplt(Vec3::splat(0.8)).all();
            let is_out = relative.cmplt(Vec3::splat(-0.01)).any() || relative.cmpgt(Vec3::splat(1.01)).any();
            let found = grid.find(point);
            if let Some(Located { tet, weights }) = found {
                assert!(!is_out, "{point}");
                let mut there = Vec3::ZERO;
                for (node, weight) in lattice.tets[tet as usize].iter().zip(weights) {
                    there += place(&lattice.position[*node as usize]) * weight;
                }
                assert!(there.distance(point) < 1e-7, "{there} {point}");
                inside += 1;
            }
            count += u32::from(is_deep);
            missed += u32::from(is_deep && found.is_none());
        }
        assert!(inside > 100 && count > 50 && missed == 0, "{inside} {count} {missed}");
        // Negative control: tets far from the box are not there.
        let nowhere = TetGrid::new((&lattice.position, &lattice.tets), (Vec3::ONE, Vec3::ONE * 2.0), 0.01);
        assert_eq!(nowhere.find(sponge.origin + 0.5 * size), None);
    }
}
