//! Pairs of surface nodes of sponges, and the contact of nodes; `pairs` and `touch` have the formulas.

use glam::Vec3;

use super::descent::Local;
use crate::{
    lanes::{self, LANES, Simd, f32x8, select},
    layout::constants,
    params::Params,
    vector::plus,
};

constants! {
    /// Scalar product of the normals, of opposite sign, above which two surfaces face each other \[1\].
    const MINIMUM_FACING: f32 = 0.1;
    /// What is added to it for two nodes of rims, whose normals are known less well \[1\].
    const RIM_FACING: f32 = 0.6;
    /// How far the tangent planes of a pair may have passed each other, in edges.
    const PAIR_OVERLAP: f32 = 1.0;
    /// How far they may be from each other, in edges.
    const PAIR_GAP: f32 = 0.6;
    /// Distance along the surface within which nodes push each other, in edges. Nodes on a square of one edge then feel a surface
    /// that is stiff to 6 % everywhere.
    const PAIR_REACH: f32 = 1.5;
    /// Range of the opposition of the normals in which a pair comes to its full stiffness \[1\].
    const FACING_RANGE: f32 = 0.4;
    const PI: f32 = std::f32::consts::PI;
}

/// A pair, the same for both of its nodes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    /// From the second to the first.
    pub(super) normal: Vec3,
    /// Excess of the opposition of their normals over the limit \[1\].
    facing: f32,
    /// Distance along the normal, at the beginning of the step \[m\].
    gap: f32,
    /// Square of the tangential distance \[m^2\].
    aside: f32,
}

impl Pair {
    /// The pair of two nodes, with weights as the lengths of their normals; none where their surfaces do not face each
    /// other.
    pub(crate) fn new([a, b]: [[f32; 4]; 2], [normal_a, normal_b]: [[f32; 4]; 2]) -> Option<Self> {
        let [x_a, x_b, n_a, n_b] = [a, b, normal_a, normal_b].map(vector);
        let across = -n_a.dot(n_b);
        // Most pairs are on the same side of a sponge.
        if across <= 0.0 {
            return None;
        }
        let (p_a, p_b) = (n_a.dot(n_a).sqrt(), n_b.dot(n_b).sqrt());
        let facing = across / (p_a * p_b) - (MINIMUM_FACING + RIM_FACING * (1.0 - p_a.max(p_b)));
        if facing <= 0.0 {
            return None;
        }
        let towards = n_b - n_a;
        let normal = towards / towards.dot(towards).sqrt();
        let apart = x_a - x_b;
        let gap = normal.dot(apart);
        Some(Self { normal, facing, gap, aside: apart.dot(apart) - gap * gap })
    }

    /// Whether the two may touch in this step.
    pub(super) fn is_near(&self, edge: f32) -> bool {
        let reach = PAIR_REACH * edge;
        self.gap > -PAIR_OVERLAP * edge && self.gap < PAIR_GAP * edge && self.aside < reach * reach
    }

    /// How squarely the two face each other, 0 to 1.
    pub(super) fn opposition(&self) -> f32 {
        (self.facing / FACING_RANGE).min(1.0)
    }

    /// Weight of the pair by the distance along the surface; over a surface its integral is 1 \[1/m^2\].
    pub(super) fn share(&self, edge: f32) -> f32 {
        let reach = PAIR_REACH * edge;
        let closeness = (1.0 - self.aside / (reach * reach)).max(0.0);
        3.0 / PI / (reach * reach) * closeness * closeness
    }

    /// How much of the face of the first is covered by an area \[m^2\] of the second, 0 to 1 beside rounding: all where the surfaces
    /// touch, none from the largest gap of a pair on.
    pub(crate) fn cover(&self, edge: f32, area: f32) -> f32 {
        let nearness = (1.0 - self.gap / (PAIR_GAP * edge)).clamp(0.0, 1.0);
        self.opposition() * (area * self.share(edge)) * nearness
    }
}

pub(super) fn vector(row: [f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// Largest distance between the nodes of a pair \[m\].
#[must_use]
pub fn pair_radius(params: &Params) -> f32 {
    // Of the cylinder that `Pair::is_near` describes.
    let reach = (PAIR_REACH * PAIR_REACH + PAIR_OVERLAP * PAIR_OVERLAP).sqrt();
    let edges = (0..).zip(&params.sponges).filter(|(index, _)| params.meets_any(*index));
    edges.map(|(_, sponge)| sponge.contact_edge()).fold(0.0, f32::max) * reach
}

/// Contact of nodes, for vertex block descent; empty in scenes without any.
#[derive(Clone, Copy)]
pub(super) struct Touch<'a> {
    pub(super) force: &'a [[f32; 4]],
    pub(super) stiffness: &'a [[f32; 4]],
    pub(super) between: &'a [[f32; 4]],
}

impl Touch<'_> {
    /// Adds the contact of eight nodes to their energy. Nodes in contact move to their minimum, without over-relaxation.
    #[inline(always)]
    pub(super) fn add<S: Simd>(&self, simd: S, nodes: &[u32; LANES], local: &mut Local<S>) {
        if self.force.is_empty() {
            return;
        }
        let [x, y, z, _] = lanes::gather_rows(simd, self.force, nodes);
        local.force = plus(local.force, [x, y, z]);
        let [xx, yy, zz, _] = lanes::gather_rows(simd, self.stiffness, nodes);
        let [xy, xz, yz, _] = lanes::gather_rows(simd, self.between, nodes);
        let trace: f32x8<S> = xx + yy + zz;
        let stiffness = &mut local.stiffness;
        for (sum, own) in stiffness.iter_mut().zip([xx, yy, zz, xy, xz, yz]) {
            *sum += own;
        }
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        local.strain += select(trace.simd_gt(zero), one, zero);
    }
}
