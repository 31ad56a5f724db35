//! Neo-Hookean constraints of the tets, colour by colour \[MM21\].
//!
//! With the stable Neo-Hookean energy per tet, and the columns f of the deformation gradient:
//!
//! ```text
//! C_D = |F|,   1 / a_D = mu V,      C_H = J - 1 - mu / lambda,   1 / a_H = lambda V
//! ((1 + tau / h) G W G^T + diag(a_D, a_H) / h^2) l = -(C + tau / h G (p - x)),   p += W G^T l
//! ```
//!
//! V is the volume that the tet stands for. G has the gradients of both. Both are far from zero at rest, with forces that
//! cancel, so that they must be solved together. The multipliers begin at zero, so that more than one sweep per step does
//! not converge to the material: steps must be short instead.
//!
//! F' are the cofactors of F, and g, a the gradients by F and by F' - F. The change is `w (s g + v a)`, where
//! `s = l_D / |F| + l_H` and `v = l_H`. Products of g and a, and s, are as small as the strain.

use crate::{
    columns::Columns,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, Simd, f32x8, select},
    params::{Params, Solver, SpongeParams},
    pbd::tets::{Law, TetLanes, sweep},
    vector::{Vec3x8, cross, dot, minus, negative, plus, times},
};

declare! {
    needs: [Sponge, Solver(XpbdNeoHookean)],
    reads: [NodePosition, NodePredicted, NodeTopology],
    writes: [NodePredicted],
    oracle: crate::oracle::pbd::xpbd_neo_hookean,
    bound: 1.5e-4,
    twin: [pass(NAME, Colors)],
    constants: {
        /// Square of the norm of a deformation below which it has no direction.
        const MINIMUM_SQUARE: f32 = 1.0e-12;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    sweep::<NeoHookean>(cpu, params, &mut columns.nodes);
}

struct NeoHookean;

/// Gradients by the nodes, of derivatives by the columns; times the edge.
#[inline(always)]
fn gradient<S: Simd>([d, e, f]: [Vec3x8<S>; 3]) -> [Vec3x8<S>; 4] {
    [negative(plus(d, f)), minus(d, f), plus(e, f), minus(f, e)]
}

impl Law for NeoHookean {
    const SOLVER: Solver = Solver::XpbdNeoHookean;

    #[inline(always)]
    fn solve<S: Simd>(simd: S, sponge: &SpongeParams, step: f32, tet: &mut TetLanes<S>) {
        let one = lanes::splat(simd, 1.0);
        let splat = |value: f32| lanes::splat(simd, value);
        let scale = splat(1.0 / sponge.edge);
        let volume = sponge.edge * sponge.edge * sponge.edge / 12.0;
        let own = splat(volume * step * step) * tet.weight;
        let soft_norm = one / (splat(sponge.mu) * own);
        let soft_ratio = one / (splat(sponge.lambda) * own);
        let damping = splat(sponge.damping / step);
        let f = tet.columns(scale);
        let area = [cross(f[1], f[2]), cross(f[2], f[0]), cross(f[0], f[1])];
        let square = dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2]);
        let inverse = one / select(square.simd_gt(splat(MINIMUM_SQUARE)), square, one);
        let by_norm = gradient(f);
        let apart = gradient([minus(area[0], f[0]), minus(area[1], f[1]), minus(area[2], f[2])]);
        let change_of_ratio = dot(f[0], area[0]) - one;
        let zero = splat(0.0);
        let (mut nn, mut na, mut aa) = (zero, zero, zero);
        let (mut norm_rate, mut apart_rate) = (zero, zero);
        for vertex in 0..4 {
            let (n, a, w) = (by_norm[vertex], apart[vertex], tet.w[vertex]);
            nn += w * dot(n, n);
            na += w * dot(n, a);
            aa += w * dot(a, a);
            let way = minus(tet.p[vertex], tet.old[vertex]);
            norm_rate += dot(n, way);
            apart_rate += dot(a, way);
        }
        let factor = (one + damping) * (scale * scale);
        let (nn, na, aa) = (nn * factor, na * factor, aa * factor);
        let slowed_norm = damping * (norm_rate * scale) * inverse;
        let slowed_ratio = damping * ((norm_rate + apart_rate) * scale);
        let right = splat(sponge.mu / sponge.lambda) - change_of_ratio - slowed_ratio;
        let determinant: f32x8<S> =
            (nn * aa - na * na + nn * soft_ratio) * inverse + (nn + na + na + aa + soft_ratio) * soft_norm;
        let both = na + aa;
        let to_both = -(both + na * (right * inverse))
            - soft_norm * (change_of_ratio + slowed_ratio)
            - (both + soft_ratio) * slowed_norm;
        let to_apart = nn * (right * inverse) + (nn + na) * (one + slowed_norm) + soft_norm * right;
        let (to_both, to_apart) = (to_both / determinant * scale, to_apart / determinant * scale);
        for vertex in 0..4 {
            let change = plus(times(by_norm[vertex], to_both), times(apart[vertex], to_apart));
            tet.p[vertex] = plus(tet.p[vertex], times(change, tet.w[vertex]));
        }
    }
}
