//! Reaction of the suction of particles on the corners of their tets.
//!
//! ```text
//! F_ik = -m (b_ik a_i + w_i x r_ik)                        r_ik = x_k - (mean of the corners)
//! w_i = I_i^-1 (x_i - sum_k b_ik x_k) x a_i                I_i = sum_k (|r_ik|^2 - r_ik r_ik^T)
//! a_k += r sum_i F_ik / m_k
//! ```
//!
//! with the acceleration `a_i` of the particle by suction. Weights in means are not those of the place of a particle that is outside of
//! the sponge. The least couple of forces on the corners, with `w_i`, keeps the angular momentum there.
//!
//! Takes the place of `couple::zero_distance`: a node without water in its tets is not pulled, as nothing holds it by drag either.

use super::rows::WEIGHT;
use crate::{
    column::padded,
    columns::{Columns, Fluid},
    couple::impulses::accelerate,
    cpu::Cpu,
    divergence::symmetric::Symmetric,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select, with_lanes},
    params::Params,
    vector::{Vec3x8, cross, minus, negative, plus, splat, times},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidPosition, FluidSuction, FluidCorners, FluidShares, ControlNode, ControlPosition, ControlCorners,
        NodePosition, NodeSponge, NodeAcceleration,
    ],
    writes: [FluidCornerForces, NodeAcceleration],
    oracle: crate::oracle::tets::suction,
    bound: 6e-6,
    twin_bound: 1.5e-5,
    twin: [pass("tets::corner_forces", Fluid), pass(NAME, Controls)],
    constants: {
        /// Determinant over the cube of the trace below which corners that lie on a line are not turned.
        const MINIMUM_TURN: f32 = 1.0e-4;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    corner_forces(cpu, params, columns);
    let (forces, controls) = (&columns.fluid.corner_forces.0, &columns.controls);
    let mut sums = vec![[0.0_f32; 4]; padded(controls.node.len())];
    cpu.for_chunks(&mut sums[..], |first, sums| {
        let lists = controls.corners.chunk(first);
        with_lanes!(cpu, simd => {
            for row in (0..sums.len()).step_by(LANES) {
                let mut sum = splat(simd, [0.0; 3]);
                for entry in lists.group(row) {
                    let [x, y, z, _] = lanes::gather_rows(simd, forces.as_flattened(), entry);
                    sum = plus(sum, [x, y, z]);
                }
                let [x, y, z] = sum;
                lanes::store_rows(sums, row, [x, y, z, lanes::splat(simd, 0.0)]);
            }
        });
    });
    accelerate(params, &mut columns.nodes, &controls.node, &sums);
}

fn corner_forces(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, suction, corners, shares, corner_forces, .. } = &mut columns.fluid;
    let controls = &columns.controls.position;
    corner_forces.0.resize(position.len(), [[0.0; 4]; 4]);
    cpu.for_chunks(&mut corner_forces.0[..], |first, forces| {
        with_lanes!(cpu, simd => {
            for row in (0..forces.len()).step_by(LANES) {
                if corners.are_outside(first + row) {
                    forces[row..row + LANES].fill([[0.0; 4]; 4]);
                    continue;
                }
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let [ax, ay, az, _] = lanes::load_rows(simd, suction, first + row);
                let place = |corner| lanes::gather_rows(simd, controls, &corners.entry(first + row, corner));
                // Relative to the particle.
                let around = [0, 1, 2, 3].map(|corner| {
                    let [xk, yk, zk, _] = place(corner);
                    minus([xk, yk, zk], [x, y, z])
                });
                let weights = [0, 1, 2, 3].map(|corner| shares.load(simd, first + row, corner)[WEIGHT]);
                let force = times([ax, ay, az], lanes::splat(simd, -params.fluid.particle_mass));
                for (corner, force) in split(simd, around, weights, force).into_iter().enumerate() {
                    let [x, y, z] = force.map(|axis| axis.to_array());
                    for lane in 0..LANES {
                        forces[row + lane][corner] = [x[lane], y[lane], z[lane], 0.0];
                    }
                }
            }
        });
    });
}

/// Parts of the force at the origin, by weights, whose moment is that of the force.
#[inline(always)]
fn split<S: Simd>(
    simd: S,
    corners: [Vec3x8<S>; 4],
    weights: [f32x8<S>; 4],
    force: Vec3x8<S>,
) -> [Vec3x8<S>; 4] {
    let zero = lanes::splat(simd, 0.0);
    let (mut centre, mut place) = ([zero; 3], [zero; 3]);
    for (corner, weight) in corners.into_iter().zip(weights) {
        centre = plus(centre, times(corner, lanes::splat(simd, 0.25)));
        place = plus(place, times(corner, weight));
    }
    let mut inertia = Symmetric::splat(simd, 0.0);
    for corner in corners {
        let arm = minus(corner, centre);
        inertia.add_square(arm, arm);
    }
    let trace = inertia.along[0] + inertia.along[1] + inertia.along[2];
    inertia = Symmetric { along: inertia.along.map(|axis| trace - axis), between: negative(inertia.between) };
    let (inverse, determinant) = inertia.adjugate();
    let turns = determinant.simd_gt(lanes::splat(simd, 8.0 * MINIMUM_TURN) * trace * trace * trace);
    let scale = select(turns, lanes::splat(simd, 1.0) / select(turns, determinant, trace), zero);
    // The parts by weights turn as a force at their place does.
    let turn = times(inverse.times(cross(force, place)), scale);
    std::array::from_fn(|corner| {
        plus(times(force, weights[corner]), cross(turn, minus(corners[corner], centre)))
    })
}
