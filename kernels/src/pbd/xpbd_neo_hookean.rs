//! Neo-Hookean constraints of the tets, colour by colour \[MM21\].
//!
//! With the energy of `pbd::vbd` per tet, and the columns f of the deformation gradient:
//!
//! ```text
//! C_D = |F|,   1 / a_D = mu V,      C_H = J - 1 - mu / lambda,   1 / a_H = lambda V
//! ((1 + tau / h) G W G^T + diag(a_D, a_H) / h^2) l = -(C + tau / h G (p - x)),   p += W G^T l
//! ```
//!
//! G holds the gradients of both. Both are far from zero at rest, with forces that cancel, so they must be solved together; and
//! the multipliers begin at zero, so that more than one sweep a step does not converge to the material: steps must be short
//! instead.

use crate::{
    columns::{Column::*, Columns},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, Simd, f32x8, prelude::*, select},
    params::{Params, Solver, SpongeParams},
    pbd::tets::{Law, TetLanes, sweep},
    vector::{Vec3x8, cross, dot, minus, negative, plus, times},
};

/// `pbd::xpbd_neo_hookean`: one sweep over all colours.
pub static KERNEL: Kernel = Kernel {
    name: "pbd::xpbd_neo_hookean",
    needs: &[Need::Sponge, Need::Solver(Solver::XpbdNeoHookean)],
    reads: &[NodePosition, NodePredicted, NodeTopology],
    writes: &[NodePredicted],
    cpu,
};

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
        let [soft_norm, soft_ratio] = [sponge.mu, sponge.lambda].map(|m| 1.0 / (m * volume * step * step));
        let damping = splat(sponge.damping / step);
        let f = tet.columns(scale);
        let norm = (dot(f[0], f[0]) + dot(f[1], f[1]) + dot(f[2], f[2])).sqrt();
        let inverse = one / select(norm.simd_gt(splat(1.0e-6)), norm, one);
        let by_norm = gradient([times(f[0], inverse), times(f[1], inverse), times(f[2], inverse)]);
        let area = cross(f[1], f[2]);
        let by_ratio = gradient([area, cross(f[2], f[0]), cross(f[0], f[1])]);
        let ratio = dot(f[0], area) - splat(1.0 + sponge.mu / sponge.lambda);
        let zero = splat(0.0);
        let (mut nn, mut rr, mut nr) = (zero, zero, zero);
        let (mut norm_rate, mut ratio_rate) = (zero, zero);
        for vertex in 0..4 {
            let (n, r, w) = (by_norm[vertex], by_ratio[vertex], tet.w[vertex]);
            nn += w * dot(n, n);
            rr += w * dot(r, r);
            nr += w * dot(n, r);
            let way = minus(tet.p[vertex], tet.old[vertex]);
            norm_rate += dot(n, way);
            ratio_rate += dot(r, way);
        }
        let factor = (one + damping) * (scale * scale);
        let (nn, rr, nr) = (nn * factor + soft_norm, rr * factor + soft_ratio, nr * factor);
        let first = -(norm + damping * (norm_rate * scale));
        let second = -(ratio + damping * (ratio_rate * scale));
        let determinant: f32x8<S> = nn * rr - nr * nr;
        let to_norm = (rr * first - nr * second) / determinant * scale;
        let to_ratio = (nn * second - nr * first) / determinant * scale;
        for vertex in 0..4 {
            let change = plus(times(by_norm[vertex], to_norm), times(by_ratio[vertex], to_ratio));
            tet.p[vertex] = plus(tet.p[vertex], times(change, tet.w[vertex]));
        }
    }
}
