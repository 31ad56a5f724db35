//! What a ray sees of a sponge below its outer surface: pores, their shade, wetness.

use super::foam::{Foam, foam};
use super::tree::Hit;
use crate::render::{colour::smooth, sponge::Surface};
use glam::{Mat3, Vec3};

/// Deepest place in pores that a ray reaches (m).
const DEPTH: f32 = 0.0042;
/// Distance over which the gradient of the walls is taken (m).
const STENCIL: f32 = 0.25e-3;
const DRY: Vec3 = Vec3::new(0.90, 0.66, 0.25);
const SOAKED: Vec3 = Vec3::new(0.46, 0.25, 0.055);

#[cfg(feature = "gpu")]
shared_with_shaders!(SKIN: DEPTH, STENCIL, DRY, SOAKED);

/// The place of a sponge that a ray sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Skin {
    pub(super) normal: Vec3,
    /// Normal of the outer surface, without pores.
    pub(super) outer: Vec3,
    pub(super) albedo: Vec3,
    /// Share of the light that reaches the place in its pore, 0 to 1.
    pub(super) open: f32,
    /// Wetness, 0 to 1.
    pub(super) wet: f32,
}

/// A triangle of the sponge.
struct Facet<'a> {
    sponge: &'a Surface,
    corners: [usize; 3],
    weights: [f32; 3],
}

impl Facet<'_> {
    fn mix(&self, of: &[Vec3]) -> Vec3 {
        let [a, b, c] = self.corners.map(|node| of[node]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }

    fn wetness(&self) -> f32 {
        let [a, b, c] = self.corners.map(|node| self.sponge.wetness[node]);
        a * self.weights[0] + b * self.weights[1] + c * self.weights[2]
    }

    /// From directions in the world to those of the sponge at rest.
    fn to_rest(&self) -> Mat3 {
        let frame = |places: &[Vec3]| {
            let [a, b, c] = self.corners.map(|node| places[node]);
            let (e, f) = (b - a, c - a);
            Mat3::from_cols(e, f, e.cross(f).normalize_or_zero())
        };
        let now = frame(&self.sponge.positions);
        if now.determinant().abs() < 1e-20 {
            Mat3::IDENTITY
        } else {
            frame(&self.sponge.rest) * now.inverse()
        }
    }
}

/// Wetness and normal of the outer surface where a ray meets it.
pub(super) fn facet(sponge: &Surface, hit: &Hit<[f32; 2]>) -> (f32, Vec3) {
    let [u, v] = hit.place;
    let corners = sponge.triangles[hit.index as usize].1;
    let facet = Facet { sponge, corners, weights: [1.0 - u - v, u, v] };
    (facet.wetness(), facet.mix(&sponge.normals).normalize_or_zero())
}

/// Share of a place of a sponge that free water covers, from the shares of the nodes; 0 without any.
pub(super) fn covered(sponge: &Surface, hit: &Hit<[f32; 2]>, films: &[f32]) -> f32 {
    let [u, v] = hit.place;
    let [a, b, c] =
        sponge.triangles[hit.index as usize].1.map(|node| films.get(node).copied().unwrap_or(0.0));
    a * (1.0 - u - v) + b * u + c * v
}

/// Whether a ray that meets the outer surface in a pore leaves the sponge again, after a distance (m), before it meets a wall. Pores
/// cut the outline.
pub(super) fn is_notched(sponge: &Surface, hit: &Hit<[f32; 2]>, direction: Vec3, exit: f32) -> bool {
    let [u, v] = hit.place;
    let corners = sponge.triangles[hit.index as usize].1;
    let facet = Facet { sponge, corners, weights: [1.0 - u - v, u, v] };
    let (foam, place) = (foam(), facet.mix(&sponge.rest));
    let start = foam.distance(place);
    if start >= 0.0 {
        return false;
    }
    let inward = facet.to_rest() * direction;
    let (way, _) = descend(foam, place, inward.normalize_or_zero(), start);
    way >= exit * inward.length()
}

/// The skin of a sponge where a ray meets it.
///
/// `pixel` is the side of a pixel there (m): finer detail is left out. `film` is the wetness of water on it.
pub(super) fn skin(
    sponge: &Surface,
    foam: &Foam,
    hit: &Hit<[f32; 2]>,
    direction: Vec3,
    pixel: f32,
    film: f32,
) -> Skin {
    let [u, v] = hit.place;
    let corners = sponge.triangles[hit.index as usize].1;
    let facet = Facet { sponge, corners, weights: [1.0 - u - v, u, v] };
    let wet = facet.wetness().max(film);
    let normal = facet.mix(&sponge.normals).normalize_or_zero();
    let place = facet.mix(&sponge.rest);
    let start = foam.distance(place);
    let detail = 1.0 - smooth(0.4e-3, 1.6e-3, pixel);
    let (mut depth, mut bent) = (0.0, normal);
    // Away from pores there is nothing to march through and nothing to bend.
    if start < 0.5 {
        let to_rest = facet.to_rest();
        let inward = (to_rest * direction).normalize_or_zero();
        let (way, value) = descend(foam, place, inward, start);
        // A rim is at least as wide as a pixel, or it would jump from sample to sample.
        let rim = smooth(0.0, (1e3 * pixel).max(0.05), -start);
        depth = (way * (-direction.dot(normal)).max(0.15)).min(DEPTH) * rim;
        let end = place + inward * way;
        let here = foam.distance(end);
        let slope =
            Vec3::from(std::array::from_fn(|axis| foam.distance(end + Vec3::AXES[axis] * STENCIL) - here));
        let wall = to_rest.transpose() * (slope * (-1.0 / (STENCIL * 1e3)));
        // The wall of a pore faces into it, near to it only.
        let rim = 1.0 - smooth(0.0, 0.5, value);
        bent = (normal + (wall - normal * wall.dot(normal)) * (0.72 * rim * detail)).normalize_or(normal);
    }
    let fine = 0.92 + 0.16 * detail * foam.distance(place * 4.3).clamp(-0.5, 0.5);
    let base = DRY.lerp(SOAKED, smooth(0.03, 0.75, wet)) * fine;
    // Light from the bottom of a pore has the colour of its walls.
    let open = libm::expf(-depth / 1.5e-3);
    let albedo = base * Vec3::new(1.0, 0.72 + 0.28 * open, 0.5 + 0.5 * open);
    Skin { normal: bent, outer: normal, albedo, open, wet }
}

/// Length of the way to the wall of a pore (m), and the distance from it there (mm).
fn descend(foam: &Foam, place: Vec3, direction: Vec3, start: f32) -> (f32, f32) {
    let (mut way, mut value, mut before) = (0.0, start, (0.0, start));
    while value < 0.0 && way < DEPTH {
        before = (way, value);
        way += (-value * 0.8e-3).max(0.25e-3);
        value = foam.distance(place + direction * way);
    }
    if value > 0.0 && before.1 < 0.0 {
        way = before.0 + (way - before.0) * before.1 / (before.1 - value);
        value = 0.0;
    }
    (way, value)
}
