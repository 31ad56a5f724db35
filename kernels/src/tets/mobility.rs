//! How much particles in sponges and nodes respond to pressure, once a step.
//!
//! ```text
//! b_i = 1 / (1 + h k_i),   k_i = beta_i + gamma_i |v_i - u_i|,   u_i = sum_k b_ik u_k
//! m'_a = sum_i b_ia (1 - b_i) m                            water that the drag moves with a node
//! D_a = m_a + m'_a + h (h + damping) K_a / 4,   K_a = 8 V_a / a^2 (mu + lambda / 3)
//! A_i <- (b_i + (1 - b_i) sum_k b_ik m'_k / D_k) A_i + h^2 m sum_k |g_ik|^2 / D_k
//! ```
//!
//! See `couple::solid_moments` for what holds a node, and `couple::solid_diagonal` for the diagonal A.

use super::rows::{CORNER_WEIGHT, CornerRows, mean};
use crate::{
    columns::{Columns, Controls, Fluid, lane},
    couple::compliance::response,
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, with_lanes},
    params::Params,
    vector::{dot, minus},
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Barycentric],
    reads: [
        FluidVelocity, FluidDragRate, FluidCorners, FluidShares, FluidPushed, FluidPressureRows, ControlNode,
        ControlPosition, ControlMaterial, ControlCorners, NodePosition, NodeSponge, NodeWetting,
    ],
    writes: [FluidPushed, FluidPressureRows, ControlCompliance],
    oracle: crate::oracle::tets::mobility,
    bound: 2e-5,
    twin: [
        pass("tets::hold", Fluid),
        pass("tets::drawn", Controls),
        pass("couple::solid_compliance", Nodes),
        pass(NAME, Fluid),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    mobilities(cpu, params, columns);
    compliances(cpu, params, columns);
    diagonal(cpu, params, columns);
}

/// How much the drag leaves of a change of the velocity of every particle.
fn mobilities(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let material = &columns.controls.material;
    let Fluid { velocity, drag_rate, corners, shares, pushed, .. } = &mut columns.fluid;
    cpu.for_chunks(&mut pushed[..], |first, pushed| {
        with_lanes!(cpu, simd => {
            let one = lanes::splat(simd, 1.0);
            for row in (0..pushed.len()).step_by(LANES) {
                let mut mobility = one;
                if !corners.are_outside(first + row) {
                    let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                    let u = mean(simd, material, (corners, shares), first + row);
                    let relative = minus([vx, vy, vz], u);
                    let [linear, inertial, _, _] = lanes::load_rows(simd, drag_rate, first + row);
                    let rate = (linear + inertial * dot(relative, relative).sqrt()) * params.step;
                    mobility = one / (one + rate);
                }
                let [qx, qy, qz, _] = lanes::load_rows(simd, pushed, row);
                lanes::store_rows(pushed, row, [qx, qy, qz, mobility]);
            }
        });
    });
}

/// What nodes respond to impulses with.
fn compliances(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (pushed, shares, nodes) = (&columns.fluid.pushed, &columns.fluid.shares, &columns.nodes);
    let Controls { node, position, material, corners: lists, compliance, .. } = &mut columns.controls;
    let particles = columns.rows.fluid;
    let mass = params.fluid.particle_mass;
    compliance.clear();
    compliance.resize(position.len(), [0.0; 4]);
    cpu.for_chunks(&mut compliance[..node.len()], |first, compliance| {
        for (row, compliance) in compliance.iter_mut().enumerate() {
            let mut drawn = 0.0;
            for place in lists.of(first + row, 4 * particles) {
                let particle = place as usize / 4;
                drawn += shares.0.as_flattened()[place as usize][CORNER_WEIGHT]
                    * (1.0 - pushed[particle][lane::fluid::pushed::MOBILITY]);
            }
            let own = node[first + row] as usize;
            let volume = position[first + row][lane::controls::position::VOLUME];
            let drawn = drawn * mass;
            let response = response(params, nodes, (own, volume), drawn);
            *compliance =
                [response, drawn * response, 0.0, material[first + row][lane::controls::material::VOLUME]];
        }
    });
}

/// The diagonal of the pressure solve.
fn diagonal(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let compliance = &columns.controls.compliance;
    let Fluid { corners, shares, pushed, pressure_rows, .. } = &mut columns.fluid;
    let scale = params.step * params.step * params.fluid.particle_mass;
    let shares: &CornerRows = shares;
    cpu.for_chunks(&mut pressure_rows[..], |first, rows| {
        with_lanes!(cpu, simd => {
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..rows.len()).step_by(LANES) {
                if corners.are_outside(first + row) {
                    continue;
                }
                let (mut follows, mut direct) = (zero, zero);
                for corner in 0..4 {
                    let [compliance, drawn, ..] = lanes::gather_rows(simd, compliance, &corners.entry(first + row, corner));
                    let [gx, gy, gz, weight] = shares.load(simd, first + row, corner);
                    follows += weight * drawn;
                    direct += dot([gx, gy, gz], [gx, gy, gz]) * compliance;
                }
                let [.., own] = lanes::load_rows(simd, pushed, first + row);
                let [pressure, change, diagonal, left] = lanes::load_rows(simd, rows, row);
                let diagonal = (own + (one - own) * follows) * diagonal + direct * scale;
                lanes::store_rows(rows, row, [pressure, change, diagonal, left]);
            }
        });
    });
}
