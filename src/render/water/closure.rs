//! Share of a neighbourhood that solids leave free. The density over it shows no gap where water meets a solid.

use super::density::THIN;
use super::grid::Grid;
use super::kernels::REACH;
use crate::render::{shapes::Solid, sponge::Surface};
use glam::Vec3;
use std::ops::Range;

/// Columns that are looked at together; rows of a grid are multiples of it.
const EIGHT: usize = 8;
/// Side of the piece of surface that a surfel stands for, at most (spacings).
const PIECE: f32 = 2.0;
/// Distance from the outer surface of a sponge up to which water counts as that of its pores, in spacings: no kernels are there.
const PORES: f32 = 0.2;

#[cfg(feature = "gpu")]
shared_with_shaders!(CLOSURE: PORES);

/// A piece of the surface of a sponge.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Surfel {
    centre: Vec3,
    normal: Vec3,
}

impl Surfel {
    /// Its middle (m).
    pub(in crate::render) fn place(&self) -> Vec3 {
        self.centre
    }

    /// Its outward unit normal.
    #[cfg(feature = "gpu")]
    pub(in crate::render) fn normal(&self) -> Vec3 {
        self.normal
    }

    /// Weight of the surfel at a point nearer than `reach`, and the distance of the point from its plane (m).
    pub(super) fn share(&self, point: Vec3, reach: f32) -> (f32, f32) {
        let r = point - self.centre;
        let weight = (1.0 - r.length_squared() / (reach * reach)).max(0.0);
        let weight = weight * weight;
        (weight * weight, r.dot(self.normal))
    }
}

/// Share of a kernel in front of a plane, with the middle of the kernel at a distance in front of it, in radii. It is the integral of
/// `(315/256) (1 - x^2)^4`.
pub(super) fn share(distance: f32) -> f32 {
    let x = distance.clamp(-1.0, 1.0);
    let y = x * x;
    0.5 + 1.230_468_8 * x * (1.0 + y * (-4.0 / 3.0 + y * (1.2 + y * (-4.0 / 7.0 + y / 9.0))))
}

/// Pieces of the surface of a sponge, at most about two spacings apart.
pub(in crate::render) fn surfels(sponge: &Surface, spacing: f32) -> Vec<Surfel> {
    let mut surfels = Vec::new();
    for (_, corners) in &sponge.triangles {
        let [a, b, c] = corners.map(|node| sponge.positions[node]);
        let (e, f) = (b - a, c - a);
        let cross = e.cross(f);
        let normal = cross.normalize_or_zero();
        let parts = ((cross.length() * 0.5).sqrt() / (PIECE * spacing)).ceil().clamp(1.0, 4.0);
        let count = parts as usize;
        for i in 0..count {
            for j in 0..count - i {
                let [u, v] = [i, j].map(|place| (place as f32 + 0.33) / parts);
                surfels.push(Surfel { centre: a + e * u + f * v, normal });
                if i + j + 1 < count {
                    let further = 0.33 / parts;
                    surfels.push(Surfel { centre: a + e * (u + further) + f * (v + further), normal });
                }
            }
        }
    }
    surfels
}

/// Distances of surfaces from the nodes of a slab.
pub(super) struct Distances<'a> {
    /// Signed distance to sponges of every node (m), infinite far from all; empty without any near the slab.
    sponge: Vec<f32>,
    bodies: Vec<&'a Solid<'a>>,
    reach: f32,
    pores: f32,
}

impl<'a> Distances<'a> {
    /// Distances for the nodes of some layers.
    pub(super) fn new(
        grid: &Grid,
        layers: Range<usize>,
        (surfels, bodies): (impl ExactSizeIterator<Item = Surfel>, &'a [Solid<'a>]),
        densities: &[f32],
        spacing: f32,
    ) -> Self {
        let reach = REACH * spacing;
        let low = grid.node(0, 0, layers.start) - reach;
        let high = grid.node(grid.sides[0], grid.sides[1], layers.end) + reach;
        let near = |solid: &&Solid<'_>| {
            solid.is_plane()
                || ((solid.position + solid.radius).cmpgt(low).all()
                    && (solid.position - solid.radius).cmplt(high).all())
        };
        let bodies = bodies.iter().filter(near).collect();
        let sponge =
            if surfels.len() == 0 { Vec::new() } else { nearest(grid, layers, surfels, densities, reach) };
        Self { sponge, bodies, reach, pores: PORES * spacing }
    }

    /// Whether nothing is near the slab.
    pub(super) fn are_free(&self) -> bool {
        self.sponge.is_empty() && self.bodies.is_empty()
    }

    /// Writes the distances from sponges of all nodes.
    pub(super) fn copy_to(&self, distances: &mut [f32]) {
        if !self.sponge.is_empty() {
            distances.copy_from_slice(&self.sponge);
        }
    }

    /// Free share around a node of the slab, 0 to 1.
    ///
    /// `image` is its mirror image behind the floor: sponges have images there as the water has.
    pub(super) fn free(&self, (node, image): (usize, Option<usize>), place: Vec3) -> f32 {
        let of_sponge = |node: usize| {
            self.sponge.get(node).map_or(1.0, |distance| share((*distance - self.pores) / self.reach))
        };
        let mut free = of_sponge(node) * image.map_or(1.0, of_sponge);
        for body in &self.bodies {
            let distance = body.distance(place);
            if distance < self.reach {
                free *= share(distance / self.reach);
            }
        }
        free
    }
}

/// Mean distance from the planes of the surfels around.
fn nearest(
    grid: &Grid,
    layers: Range<usize>,
    surfels: impl Iterator<Item = Surfel>,
    densities: &[f32],
    reach: f32,
) -> Vec<f32> {
    // Nodes without water need no distance.
    let wet: Vec<bool> = densities
        .as_chunks::<EIGHT>()
        .0
        .iter()
        .map(|eight| eight.iter().any(|density| *density > THIN))
        .collect();
    let mut sums = vec![[0.0_f32; 2]; layers.len() * grid.layer()];
    let scale = 1.0 / (reach * reach);
    for Surfel { centre, normal } in surfels {
        grid.rows(centre, Vec3::splat(reach), layers.clone(), |y, z, x0, x1| {
            let row = (z * grid.sides[1] + y) * grid.sides[0];
            for x in (x0..x1).step_by(EIGHT).filter(|x| wet[(row + x) / EIGHT]) {
                let place = grid.node(x, y, z + layers.start) - centre;
                for (n, [sum, weights]) in sums[row + x..row + x + EIGHT].iter_mut().enumerate() {
                    let r = place + Vec3::X * (n as f32 * grid.cell.x);
                    let weight = (1.0 - r.length_squared() * scale).max(0.0);
                    let weight = weight * weight * weight * weight;
                    *sum += weight * r.dot(normal);
                    *weights += weight;
                }
            }
        });
    }
    let mean = |[sum, weights]: [f32; 2]| if weights > 1e-4 { sum / weights } else { f32::INFINITY };
    sums.into_iter().map(mean).collect()
}
