//! Energy of one node while all others are fixed: the objective of vertex block descent.
//!
//! Energy density of a tet: the compressible Neo-Hookean material of \[BW08, section 6.4.3\], with the deformation gradient
//! F and its determinant J:
//!
//! ```text
//! psi = mu / 2 (|F|^2 - 3) - mu ln J + (lambda - mu) / 2 (J - 1)^2
//! ```
//!
//! Below a fifth of its volume a sponge is mostly solid. There a tet uses the first three terms of the Taylor series of the logarithm. With
//! `K = max(J, 1/5)`,
//!
//! ```text
//! dpsi/dJ = p = (lambda - mu) (J - 1) - mu (2 K - J) / K^2,   dp/dJ = k = lambda - mu + mu / K^2
//! ```
//!
//! which is finite for any positions of the nodes, inverted tets included. At a Poisson's ratio of zero the axes are
//! independent down to there: a compressed sponge keeps its width. The energies without a logarithm \[SGK18, MM21\] contract
//! a sponge at half its thickness to half its width, and one at less to a point.
//!
//! J is linear in the position x of one node and |F|^2 quadratic, so that the energy is convex in x. A tet counts with the
//! volume that it stands for: w times its own, where w is 1 inside and larger at pits. `p_k` are the corners of the star,
//! and `c_k` the sum of the weights of the tets at a corner. Each tet has the partner u and the consecutive corners r and q
//! of its ring:
//!
//! ```text
//! G = 2 (q - u) x (r - u) / a^2,   J = (u - x) . G / a
//! -dE/dx = a mu / 12 sum_k c_k (p_k - x) + a^2 / 12 sum_tets w p G
//! H      = a mu / 12 sum_k c_k 1         + a   / 12 sum_tets w k G G^T
//! ```
//!
//! Wet material has different constants in each tet: `wetted.rs`.
//!
//! H plus the inertia m / h^2 is positive definite. p is concave, so that Newton's method overshoots at most once.
//!
//! Damping is that of a Kelvin-Voigt material with the strain rate relative to the beginning of the step. It is linear in x,
//! and acts in the configuration at that time, which conserves linear and angular momentum. With the columns g of F at that
//! time and the coefficients n of x in them:
//!
//! ```text
//! e_kl = (g_k . df_l + g_l . df_k) / 2,   s = tau / h (2 mu e + (lambda - mu) tr e 1)
//! -dD/dx = -V sum_kl n_k s_kl g_l,   H += V tau / h (mu (|n|^2 sum_k g_k g_k^T + N N^T) + (lambda - mu) N N^T),   N = sum_k n_k g_k
//! ```

use crate::{
    lanes::{self, LANES, Simd, f32x8, select},
    layout::constants,
    params::{POLYNOMIAL_RATIO, Params, Solver, SpongeParams},
    pbd::{
        obstacles::Quadratic,
        stars::{CORNERS, NEIGHBORS, StarGroup, StarShape},
        wetted::{Wet, Wetness},
    },
    vector::{Vec3x8, cross, dot, minus, plus, times},
};

constants! {
    /// How far `pbd::vbd` goes beyond the least energy, over the way there, in steps of more than one sweep \[1\].
    pub(super) const RELAXATION: f32 = 0.3;
}

/// A symmetric 3 x 3 matrix: xx, yy, zz, xy, xz, yz.
pub(super) type Symmetric<S> = [f32x8<S>; 6];

/// Adds `b b^T` times a scalar, given as `a = scale b`.
#[inline(always)]
pub(super) fn add_outer<S: Simd>(sum: &mut Symmetric<S>, a: Vec3x8<S>, b: Vec3x8<S>) {
    sum[0] += a[0] * b[0];
    sum[1] += a[1] * b[1];
    sum[2] += a[2] * b[2];
    sum[3] += a[0] * b[1];
    sum[4] += a[0] * b[2];
    sum[5] += a[1] * b[2];
}

/// Product of a symmetric matrix and a vector.
#[inline(always)]
pub(super) fn product<S: Simd>(m: &Symmetric<S>, v: Vec3x8<S>) -> Vec3x8<S> {
    [
        m[0] * v[0] + m[3] * v[1] + m[4] * v[2],
        m[3] * v[0] + m[1] * v[1] + m[5] * v[2],
        m[4] * v[0] + m[5] * v[1] + m[2] * v[2],
    ]
}

/// Inverse of a positive definite matrix.
#[inline(always)]
pub(super) fn inverse<S: Simd>(simd: S, m: &Symmetric<S>) -> Symmetric<S> {
    // Divided by its trace: the determinant of stiff material in short steps would overflow.
    let small = lanes::splat(simd, 1.0) / (m[0] + m[1] + m[2]);
    let [xx, yy, zz, xy, xz, yz] =
        [m[0] * small, m[1] * small, m[2] * small, m[3] * small, m[4] * small, m[5] * small];
    let (a, b, c) = (yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy);
    let scale = small / (xx * a + xy * b + xz * c);
    [
        a * scale,
        (xx * zz - xz * xz) * scale,
        (xx * yy - xy * xy) * scale,
        b * scale,
        c * scale,
        (xy * xz - xx * yz) * scale,
    ]
}

/// Constants of the sponges of eight nodes.
#[derive(Clone, Copy)]
pub(super) struct Material<S: Simd> {
    /// 1 for nodes of this solver, else 0.
    pub(super) own: f32x8<S>,
    pub(super) friction: f32x8<S>,
    pub(super) inverse_edge: f32x8<S>,
    pub(super) edge: f32x8<S>,
    /// a mu / 12.
    pub(super) shear: f32x8<S>,
    /// a lambda / 12.
    pub(super) volume: f32x8<S>,
    /// tau / h.
    damping: f32x8<S>,
    /// Over-relaxation beyond the minimum, over the way to it.
    pub(super) relaxation: f32x8<S>,
    damps: bool,
}

/// The constants of one sponge, in the order of [`Material`].
fn constants(sponge: &SpongeParams, step: f32) -> [f32; 8] {
    let own = if sponge.solver == Solver::Vbd { 1.0 } else { 0.0 };
    [
        own,
        sponge.friction,
        1.0 / sponge.edge,
        sponge.edge,
        sponge.edge * sponge.mu / 12.0,
        sponge.edge * sponge.lambda / 12.0,
        own * sponge.damping / step,
        if sponge.iterations > 1 { RELAXATION } else { 0.0 },
    ]
}

/// The constants of the sponges of eight nodes, most often of one sponge.
#[inline(never)]
pub(super) fn constants_of(params: &Params, sponge: &[u32], nodes: &[u32; LANES]) -> [[f32; LANES]; 8] {
    let mut columns = [[0.0; LANES]; 8];
    let mut last = None;
    let mut values = [0.0; 8];
    for (lane, node) in nodes.iter().enumerate() {
        let sponge = sponge[*node as usize];
        if last != Some(sponge) {
            values = constants(&params.sponges[sponge as usize], params.step);
            last = Some(sponge);
        }
        for (column, value) in columns.iter_mut().zip(values) {
            column[lane] = value;
        }
    }
    columns
}

impl<S: Simd> Material<S> {
    /// From the constants of eight nodes.
    #[inline(always)]
    pub(super) fn new(simd: S, columns: &[[f32; LANES]; 8]) -> Self {
        let vector = |column: usize| lanes::load_array(simd, &columns[column]);
        Self {
            own: vector(0),
            friction: vector(1),
            inverse_edge: vector(2),
            edge: vector(3),
            shear: vector(4),
            volume: vector(5),
            damping: vector(6),
            relaxation: vector(7),
            damps: columns[6] != [0.0; LANES],
        }
    }
}

/// Eight nodes and their neighbours.
pub(super) struct Star<'a, S: Simd> {
    pub(super) simd: S,
    pub(super) group: &'a StarGroup,
    pub(super) shape: &'a StarShape,
    /// Positions of the neighbours, first the corners, then the directions.
    pub(super) around: [Vec3x8<S>; NEIGHBORS],
}

impl<'a, S: Simd> Star<'a, S> {
    /// Loads the positions of the neighbours.
    #[inline(always)]
    fn new(simd: S, (group, shape): (&'a StarGroup, &'a StarShape), places: &[[f32; 4]]) -> Self {
        let zero = lanes::splat(simd, 0.0);
        let mut around = [[zero; 3]; NEIGHBORS];
        for (place, rows) in around.iter_mut().zip(&group.neighbors).take(shape.neighbors) {
            let [x, y, z, _] = lanes::gather_rows(simd, places, rows);
            *place = [x, y, z];
        }
        Self { simd, group, shape, around }
    }

    /// Elastic force on the node at `x`, its stiffness, and the largest volume change around it.
    #[inline(always)]
    fn elasticity(&self, material: &Material<S>, x: Vec3x8<S>) -> Local<S> {
        let simd = self.simd;
        let zero = lanes::splat(simd, 0.0);
        let (mut pull, mut count) = ([zero; 3], zero);
        for corner in 0..CORNERS {
            let share = lanes::load_array(simd, &self.group.shares[corner]);
            pull = plus(pull, times(minus(self.around[corner], x), share));
            count += share;
        }
        let (mut pressure, mut stiffness) = ([zero; 3], [zero; 6]);
        let mut strain = zero;
        let (shear, lame) = (material.shear, material.volume - material.shear);
        let (one, two) = (lanes::splat(simd, 1.0), lanes::splat(simd, 2.0));
        let twice = material.inverse_edge * material.inverse_edge * lanes::splat(simd, 2.0);
        for (direction, ring) in self.shape.rings.iter().enumerate() {
            let partner = self.around[CORNERS + direction];
            let out = minus(partner, x);
            let first = minus(self.around[ring[0]], partner);
            let mut r = first;
            for k in 0..4 {
                let q = if k == 3 { first } else { minus(self.around[ring[k + 1]], partner) };
                let area = times(cross(q, r), twice);
                let present = lanes::load_array(simd, &self.group.tets[4 * direction + k]);
                let own = times(area, present);
                let ratio = dot(out, area) * material.inverse_edge;
                // Without a tet its corners have no valid position.
                strain = strain.max(select(present.simd_gt(zero), (ratio - one).abs(), zero));
                let inverse = one / ratio.max(lanes::splat(simd, POLYNOMIAL_RATIO as f32));
                let slope = lame * (ratio - one) - shear * inverse * (two - ratio * inverse);
                pressure = plus(pressure, times(own, slope));
                add_outer(&mut stiffness, times(own, lame + shear * inverse * inverse), area);
                r = q;
            }
        }
        let force = plus(times(pull, shear), times(pressure, material.edge));
        for diagonal in &mut stiffness[..3] {
            *diagonal += count * shear;
        }
        Local { force, stiffness, strain }
    }

    /// Adds the damping force and its derivative; `before` are the stars at the beginning of the step, with the node at
    /// `old`.
    #[inline(always)]
    fn damp(
        &self,
        (material, wetness): (&Material<S>, Option<&Wetness<S>>),
        before: &Self,
        (x, old): (Vec3x8<S>, Vec3x8<S>),
        Local { force, stiffness, .. }: &mut Local<S>,
    ) {
        let simd = self.simd;
        // The columns lack their factor 1 / a, and n its own.
        let lame = material.volume - material.shear;
        let twice = material.shear + material.shear;
        let inverse_square = material.inverse_edge * material.inverse_edge;
        let scale = lanes::splat(simd, 0.5) * inverse_square;
        for (tet, corners) in self.shape.tets.iter().enumerate() {
            let (f, g) = (self.columns(corners, x), before.columns(corners, old));
            let df = [minus(f[0], g[0]), minus(f[1], g[1]), minus(f[2], g[2])];
            let [dd, ee, ff] =
                [rate(&g, &df, (0, 0), scale), rate(&g, &df, (1, 1), scale), rate(&g, &df, (2, 2), scale)];
            let trace = (dd + ee + ff) * lame;
            // n = -(1, 0, 1): only the first and the last row of the stress.
            let de = rate(&g, &df, (0, 1), scale) * twice;
            let across = rate(&g, &df, (0, 2), scale) * twice;
            let ef = rate(&g, &df, (1, 2), scale) * twice;
            let mut own = lanes::load_array(simd, &self.group.tets[tet]) * material.damping;
            if let Some(wetness) = wetness {
                let [size, softer] = wetness.of_tet(*corners);
                own *= softer / size;
            }
            let first = times(g[0], (dd * twice + trace + across) * own);
            let second = times(g[1], (de + ef) * own);
            let third = times(g[2], (ff * twice + trace + across) * own);
            *force = plus(*force, plus(plus(first, second), third));
            let n = plus(g[0], g[2]);
            let weight = own * inverse_square;
            add_outer(stiffness, times(n, weight * material.volume), n);
            let both = weight * twice;
            for column in g {
                add_outer(stiffness, times(column, both), column);
            }
        }
    }

    /// Columns of the deformation gradient of a tet, times the edge.
    #[inline(always)]
    fn columns(&self, [partner, q, r]: &[usize; 3], x: Vec3x8<S>) -> [Vec3x8<S>; 3] {
        let (u, q, r) = (self.around[*partner], self.around[*q], self.around[*r]);
        [minus(u, x), minus(q, r), minus(plus(q, r), plus(x, u))]
    }
}

/// One entry of the strain rate times the step, `(g_k . df_l + g_l . df_k) / 2` by a scale. A function, because a closure
/// would lose the instruction set.
#[inline(always)]
fn rate<S: Simd>(
    g: &[Vec3x8<S>; 3],
    df: &[Vec3x8<S>; 3],
    (k, l): (usize, usize),
    scale: f32x8<S>,
) -> f32x8<S> {
    (dot(g[k], df[l]) + dot(g[l], df[k])) * scale
}

/// The energy around eight nodes without inertia, to second order at their present positions.
pub(super) struct Local<S: Simd> {
    pub(super) force: Vec3x8<S>,
    pub(super) stiffness: Symmetric<S>,
    /// The largest volume change of a tet, of either sign, over the volume at rest \[1\].
    pub(super) strain: f32x8<S>,
}

/// The energy of eight nodes without inertia.
#[inline(always)]
pub(super) fn local<S: Simd>(
    simd: S,
    group: (&StarGroup, &StarShape),
    material: &Material<S>,
    (now, before, wet): (&[[f32; 4]], &[[f32; 4]], Wet<'_>),
    (x, old): (Vec3x8<S>, Vec3x8<S>),
) -> Local<S> {
    // Neither is inlined at every caller, and dry sponges do not pay for wet ones.
    if wet.wetting.is_empty() {
        return simd.vectorize(
            #[inline(always)]
            || {
                let star = Star::new(simd, group, now);
                let mut local = star.elasticity(material, x);
                if material.damps {
                    let before = Star::new(simd, group, before);
                    star.damp((material, None), &before, (x, old), &mut local);
                }
                // Further terms that are quadratic in the position of the node add their force and stiffness here, such as drag in the
                // pores.
                local
            },
        );
    }
    simd.vectorize(
        #[inline(always)]
        || {
            let star = Star::new(simd, group, now);
            let wetness = Wetness::new(simd, group, wet);
            let mut local = star.wetted_elasticity(material, &wetness, x);
            if material.damps {
                let before = Star::new(simd, group, before);
                star.damp((material, Some(&wetness)), &before, (x, old), &mut local);
            }
            local
        },
    )
}

/// The way to the minimum of an energy without obstacles, and its Hessian, with the target of the node.
#[inline(always)]
pub(super) fn minimum<S: Simd>(
    simd: S,
    Local { force, mut stiffness, .. }: Local<S>,
    (x, target, mass): (Vec3x8<S>, Vec3x8<S>, f32x8<S>),
    step: f32,
) -> (Vec3x8<S>, Quadratic<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let inertia = select(mass.simd_gt(zero), mass, one) / lanes::splat(simd, step * step);
    for diagonal in &mut stiffness[..3] {
        *diagonal += inertia;
    }
    let inverse = inverse(simd, &stiffness);
    let pull = plus(force, times(minus(target, x), inertia));
    (product(&inverse, pull), Quadratic { stiffness, inverse })
}
