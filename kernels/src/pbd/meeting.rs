//! Pairs of surface nodes of sponges; `pairs` has the formulas.

use glam::Vec3;

use crate::params::Params;

/// Scalar product of the opposite normals above which two surfaces face each other \[1\].
const FACING: f32 = 0.1;
/// Added to it for two nodes of rims, whose normals are less precise \[1\].
const ALIKE: f32 = 0.6;
/// Largest depth by which the tangent planes of a pair may have passed each other, in edges.
const DEEP: f32 = 1.0;
/// Largest distance between them, in edges.
const NEAR: f32 = 0.6;
/// Tangential distance within which nodes push each other, in edges: the stiffness of a surface of nodes one edge apart then
/// varies by 6 %.
pub(super) const REACH: f32 = 1.5;

/// A pair, the same for both of its nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    /// From the second to the first.
    pub(super) normal: Vec3,
    /// Excess of the opposition of their normals over the limit \[1\].
    pub(super) facing: f32,
    /// Distance along the normal, at the beginning of the step \[m\].
    pub(super) gap: f32,
    /// Square of the tangential distance \[m^2\].
    pub(super) aside: f32,
}

impl Pair {
    /// The pair of two nodes, with weights as the lengths of their normals; none where their surfaces do not face each
    /// other.
    pub(super) fn new([a, b]: [[f32; 4]; 2], [normal_a, normal_b]: [[f32; 4]; 2]) -> Option<Self> {
        let [x_a, x_b, n_a, n_b] = [a, b, normal_a, normal_b].map(vector);
        let across = -n_a.dot(n_b);
        // Most pairs are on the same side of a sponge.
        if across <= 0.0 {
            return None;
        }
        let (p_a, p_b) = (n_a.dot(n_a).sqrt(), n_b.dot(n_b).sqrt());
        let facing = across / (p_a * p_b) - (FACING + ALIKE * (1.0 - p_a.max(p_b)));
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
        let reach = REACH * edge;
        self.gap > -DEEP * edge && self.gap < NEAR * edge && self.aside < reach * reach
    }
}

pub(super) fn vector(row: [f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// Largest distance between the nodes of a pair \[m\].
#[must_use]
pub fn pair_radius(params: &Params) -> f32 {
    // Of the cylinder of `Pair::is_near`.
    let reach = (REACH * REACH + DEEP * DEEP).sqrt();
    let edges = (0..).zip(&params.sponges).filter(|(index, _)| params.meets_any(*index));
    edges.map(|(_, sponge)| sponge.contact_edge()).fold(0.0, f32::max) * reach
}
