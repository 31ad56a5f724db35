//! The surface of a mesh on the lattice of a sponge that was cut out of it.

use std::collections::BTreeMap;

use glam::{DMat3, Vec3};

use crate::mesh::Mesh;

/// The surface of the mesh that a sponge was made of. It follows the sponge: every corner has a tet, and weights of its nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    triangles: Vec<[u32; 3]>,
    anchors: Vec<Anchor>,
}

/// Nodes of a tet, and weights that sum to one. Corners outside of all tets have weights below zero.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Anchor {
    nodes: [u32; 4],
    weights: [f32; 4],
}

impl Skin {
    /// Of a mesh on tets at rest that are not empty, in cells of some edge \[m\]. The mesh fills a block of some size \[m\] from a lowest
    /// corner on, as far as its proportions let it.
    pub(crate) fn new(
        mesh: Mesh,
        (low, size): (Vec3, Vec3),
        (positions, tets): (&[[f32; 4]], &[[u32; 4]]),
        edge: f32,
    ) -> Self {
        let (mesh_low, mesh_high) = mesh.bounds();
        let scale = mesh_scale(&mesh, size);
        let middle = 0.5 * (mesh_low + mesh_high);
        let tets = Tets::new(positions, tets, edge);
        let anchor = |vertex: &Vec3| tets.anchor(low + 0.5 * size + (*vertex - middle) * scale);
        Self { anchors: mesh.vertices.iter().map(anchor).collect(), triangles: mesh.triangles }
    }

    /// Numbers of corners, counter-clockwise seen from outside.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Places of the corners \[m\] for positions of all nodes of the world, such as
    /// [`World::node_positions`](crate::World::node_positions).
    pub fn positions<'a>(&'a self, nodes: &'a [[f32; 4]]) -> impl ExactSizeIterator<Item = Vec3> + 'a {
        let place =
            |node: u32| nodes.get(node as usize).map_or(Vec3::ZERO, |row| Vec3::new(row[0], row[1], row[2]));
        self.anchors.iter().map(move |own| {
            own.nodes.iter().zip(own.weights).map(|(node, weight)| place(*node) * weight).sum()
        })
    }

    /// Values of the corners for values of all nodes, such as [`World::node_saturations`](crate::World::node_saturations), between those of
    /// the nodes of their tets.
    pub fn values<'a>(&'a self, nodes: &'a [f32]) -> impl ExactSizeIterator<Item = f32> + 'a {
        let value = |node: u32| nodes.get(node as usize).copied().unwrap_or(0.0);
        self.anchors.iter().map(move |own| {
            let inside = own.weights.map(|weight| weight.max(0.0));
            let sum: f32 = own.nodes.iter().zip(inside).map(|(node, weight)| value(*node) * weight).sum();
            sum / inside.iter().sum::<f32>()
        })
    }
}

/// Metres of a block of some size \[m\] per metre of the mesh in it.
pub(super) fn mesh_scale(mesh: &Mesh, size: Vec3) -> f32 {
    let (low, high) = mesh.bounds();
    (size / (high - low).max(Vec3::splat(f32::MIN_POSITIVE))).min_element()
}

/// Tets by the cells that their middles are in.
struct Tets<'a> {
    positions: &'a [[f32; 4]],
    tets: &'a [[u32; 4]],
    edge: f32,
    cells: BTreeMap<[i32; 3], Vec<u32>>,
}

impl<'a> Tets<'a> {
    fn new(positions: &'a [[f32; 4]], tets: &'a [[u32; 4]], edge: f32) -> Self {
        let mut all = Self { positions, tets, edge, cells: BTreeMap::new() };
        for (index, tet) in (0..).zip(tets) {
            let middle = tet.iter().map(|node| all.place(*node)).sum::<Vec3>() * 0.25;
            all.cells.entry(all.cell(middle)).or_default().push(index);
        }
        all
    }

    fn place(&self, node: u32) -> Vec3 {
        let row = self.positions[node as usize];
        Vec3::new(row[0], row[1], row[2])
    }

    fn cell(&self, point: Vec3) -> [i32; 3] {
        (point / self.edge).floor().to_array().map(|cell| cell as i32)
    }

    /// The tet that holds a point, or the one that the point is least outside of.
    fn anchor(&self, point: Vec3) -> Anchor {
        let [x, y, z] = self.cell(point);
        // A thin part of a mesh may be far from every tet.
        for reach in [1, 2, 4] {
            let width = 2 * reach + 1;
            let around = (0..width * width * width).map(|index| {
                [
                    x + index % width - reach,
                    y + index / width % width - reach,
                    z + index / (width * width) - reach,
                ]
            });
            let near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
            let found = near.filter_map(|tet| self.weights(*tet, point));
            let lowest = |own: &Anchor| own.weights.iter().copied().fold(f32::INFINITY, f32::min);
            if let Some(best) = found.max_by(|a, b| lowest(a).total_cmp(&lowest(b))) {
                return best;
            }
        }
        self.nearest(point)
    }

    /// The node nearest to a point.
    fn nearest(&self, point: Vec3) -> Anchor {
        let distance = |node: u32| self.place(node).distance_squared(point);
        let corners = self.tets.iter().flat_map(|tet| (0..4).map(move |slot| (tet, slot)));
        let best = corners.min_by(|(a, i), (b, j)| distance(a[*i]).total_cmp(&distance(b[*j])));
        let (nodes, slot) = best.map_or(([0; 4], 0), |(tet, slot)| (*tet, slot));
        let mut weights = [0.0; 4];
        weights[slot] = 1.0;
        Anchor { nodes, weights }
    }

    fn weights(&self, tet: u32, point: Vec3) -> Option<Anchor> {
        let nodes = self.tets[tet as usize];
        let [a, b, c, d] = nodes.map(|node| self.place(node).as_dvec3());
        let inverse = DMat3::from_cols(b - a, c - a, d - a).try_inverse()?;
        let [x, y, z] = inverse.mul_vec3(point.as_dvec3() - a).to_array();
        Some(Anchor { nodes, weights: [1.0 - x - y - z, x, y, z].map(|weight| weight as f32) })
    }
}
