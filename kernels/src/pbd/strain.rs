//! Strain constraints of the tets, colour by colour \[MCKM14; the paper, section 3.2\].
//!
//! All tets have the same shape at rest, so the deformation gradient needs no matrix: in the frame of the tet
//! its columns are
//!
//! ```text
//! f_d = (p1 - p0) / a,   f_e = (p2 - p3) / a,   f_f = (p2 + p3 - p0 - p1) / a
//! ```
//!
//! and the frame itself does not matter to isotropic constraints. Per tet, one after the other:
//!
//! ```text
//! stretch  C = |f_k| - 1,   shear  C = f_k . f_l,   volume  C = f_d . (f_e x f_f) - 1
//! dl = -(C + (tau / h) grad C . (p - x)) / ((1 + tau / h) sum w |grad C|^2 + 1 / (M V h^2))
//! p += w dl grad C
//! ```
//!
//! and last, with almost no compliance, that the volume is at least a tenth of that at rest. An inverted tet satisfies the
//! stretch and shear constraints, and would stay inverted.
//!
//! V is the volume of the tet itself: pits count only in the masses.
//!
//! Differs from the paper: a constraint has a modulus M \[Pa\] and a damping time tau \[s\], as the compliance of \[MMC16\]. There it has a
//! stiffness between 0 and 1. The sponge then does not stiffen when the step shrinks.

use crate::{
    columns::Columns,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, Simd, f32x8, select},
    params::{self, Params, SpongeParams},
    pbd::tets::{Law, TetLanes, sweep},
    vector::{Vec3x8, cross, dot, minus, negative, plus, times},
};

declare! {
    needs: [Sponge, Solver(Sbd)],
    reads: [NodePosition, NodePredicted, NodeTopology],
    writes: [NodePredicted],
    oracle: crate::oracle::pbd::strain,
    // 6e-8 m: eight units in the last place of a position.
    bound: 5e-4,
    twin: [pass(NAME, Colors)],
    constants: {
        /// Length of an edge over that at rest below which it has no direction.
        const MINIMUM_STRETCH: f32 = 1.0e-6;
        /// Smallest volume over volume at rest that a tet is pressed to.
        const MINIMUM_VOLUME_RATIO: f32 = 0.1;
        /// Compliance of that constraint over that of the volume; not zero, which would divide by zero for held nodes.
        const LIMIT_COMPLIANCE: f32 = 1.0e-3;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    sweep::<Strain>(cpu, params, &mut columns.nodes);
}

struct Strain;

impl Law for Strain {
    const SOLVER: params::Solver = params::Solver::Sbd;

    #[inline(always)]
    fn solve<S: Simd>(simd: S, sponge: &SpongeParams, step: f32, tet: &mut TetLanes<S>) {
        Solver::new(simd, sponge, step).solve(tet);
    }
}

struct Solver<S: Simd> {
    simd: S,
    inverse_edge: f32x8<S>,
    /// 1 / (M V h^2) of stretch, shear and volume.
    compliance: [f32x8<S>; 3],
    /// tau / h.
    damping: f32x8<S>,
}

impl<S: Simd> Solver<S> {
    #[inline(always)]
    fn new(simd: S, sponge: &SpongeParams, step: f32) -> Self {
        let volume = sponge.edge * sponge.edge * sponge.edge / 12.0;
        // Iterations restart with zero multipliers: each has its share of the stiffness.
        let share = sponge.iterations as f32;
        let compliance = |modulus: f32| lanes::splat(simd, share / (modulus * volume * step * step));
        Self {
            simd,
            inverse_edge: lanes::splat(simd, 1.0 / sponge.edge),
            compliance: [
                compliance(sponge.stretch_modulus),
                compliance(sponge.shear_modulus),
                compliance(sponge.volume_modulus),
            ],
            damping: lanes::splat(simd, sponge.damping_time / step),
        }
    }

    #[inline(always)]
    fn solve(&self, tet: &mut TetLanes<S>) {
        let [stretch, shear, volume] = self.compliance;
        let one = lanes::splat(self.simd, 1.0);
        let zero = [lanes::splat(self.simd, 0.0); 3];
        for column in 0..3 {
            let f = tet.columns(self.inverse_edge)[column];
            let length = dot(f, f).sqrt();
            let is_long = length.simd_gt(lanes::splat(self.simd, MINIMUM_STRETCH));
            let inverse = one / select(is_long, length, one);
            let n = times(f, inverse);
            let gradient = match column {
                0 => [negative(n), n, zero, zero],
                1 => [zero, zero, n, negative(n)],
                _ => [negative(n), negative(n), n, n],
            };
            self.correct(tet, length - one, gradient, stretch, self.damping);
        }
        for pair in [(0, 1), (0, 2), (1, 2)] {
            let f = tet.columns(self.inverse_edge);
            let (k, l) = (f[pair.0], f[pair.1]);
            self.correct(tet, dot(k, l), self.shear_gradient(pair, f), shear, self.damping);
        }
        let (ratio, gradient) = self.volume_gradient(tet);
        self.correct(tet, ratio - one, gradient, volume, self.damping);
        let (ratio, gradient) = self.volume_gradient(tet);
        let lacking = ratio - MINIMUM_VOLUME_RATIO;
        let zero = lanes::splat(self.simd, 0.0);
        let inverted = select(lacking.simd_lt(zero), lacking, zero);
        self.correct(tet, inverted, gradient, volume * LIMIT_COMPLIANCE, zero);
    }

    /// Volume over volume at rest, and its gradients times the edge.
    #[inline(always)]
    fn volume_gradient(&self, tet: &TetLanes<S>) -> (f32x8<S>, [Vec3x8<S>; 4]) {
        let [d, e, f] = tet.columns(self.inverse_edge);
        let (by_d, by_e, by_f) = (cross(e, f), cross(f, d), cross(d, e));
        let gradient = [negative(plus(by_d, by_f)), minus(by_d, by_f), plus(by_e, by_f), minus(by_f, by_e)];
        (dot(d, by_d), gradient)
    }

    /// Gradients of `f_k . f_l`, times the edge.
    #[inline(always)]
    fn shear_gradient(&self, pair: (usize, usize), [d, e, f]: [Vec3x8<S>; 3]) -> [Vec3x8<S>; 4] {
        match pair {
            (0, 1) => [negative(e), e, d, negative(d)],
            (0, 2) => [negative(plus(f, d)), minus(f, d), d, d],
            _ => [negative(e), negative(e), plus(f, e), minus(e, f)],
        }
    }

    /// Moves the nodes along the gradient of one constraint; `gradient` is given times the edge.
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "the vertex is an index into several arrays")]
    fn correct(
        &self,
        tet: &mut TetLanes<S>,
        constraint: f32x8<S>,
        gradient: [Vec3x8<S>; 4],
        compliance: f32x8<S>,
        damping: f32x8<S>,
    ) {
        let scale = self.inverse_edge;
        let mut weight = lanes::splat(self.simd, 0.0);
        let mut rate = lanes::splat(self.simd, 0.0);
        for vertex in 0..4 {
            let g = gradient[vertex];
            weight += tet.w[vertex] * dot(g, g);
            rate += dot(g, minus(tet.p[vertex], tet.old[vertex]));
        }
        let one = lanes::splat(self.simd, 1.0);
        let numerator = constraint + damping * (rate * scale);
        let denominator = (one + damping) * (weight * (scale * scale)) + compliance;
        let impulse = -(numerator / denominator) * scale;
        for vertex in 0..4 {
            tet.p[vertex] = plus(tet.p[vertex], times(gradient[vertex], impulse * tet.w[vertex]));
        }
    }
}
