//! The material of sponges in the neighbourhoods of the particles, and how much both respond to pressure, once a step.
//!
//! ```text
//! c_ia = V_s (-dW/dr) / r,   e_ia = x_a - x_i              images of the nodes in walls included
//! z_i = sum_a c_ia e_ia,   M_i = sum_a c_ia e_ia e_ia^T,   lambda_i = sum_a V_s W_ia
//! b_i = 1 / (1 + h k_i),   k_i = beta_i + gamma_i |v_i - u_i|,   u_i = sum_a w_ia u_a
//! m'_a = sum_i w_ia (1 - b_i) m                            water that the drag moves with a node
//! D_a = m_a + m'_a + h (h + damping) K_a / 4,   K_a = 8 V_a / a^2 (mu + lambda / 3)
//! B_i = b_i + (1 - b_i) sum_a w_ia m'_a / D_a,   N_i = m / 3 sum_a |c_ia e_ia|^2 / D_a
//! ```
//!
//! `1 / D_a` is the velocity of a node by an impulse, within the solve for the pressure. Its neighbours hold it by a quarter of its
//! stiffness against theirs, because they follow as well. B and N are the parts of the diagonal of the system (`couple::solid_diagonal`). B
//! is that by the particle with what the drag moves, N that by the forces on nodes.

use crate::{
    columns::{Columns, Controls, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, select, with_lanes},
    params::Params,
    smoothing::Wendland,
    symmetric::Symmetric,
    vector::{dot, minus, plus, times},
};

use super::{
    compliance::response,
    impulses::{mean_inside, weight_inside, weighted},
    solid_mirrors::Mirrors,
};

declare! {
    needs: [Fluid, Sponge, Divergence, Porous, Smoothed],
    reads: [
        FluidPosition, FluidVelocity, FluidControls, FluidControlWeights, FluidDragRate, ControlNode,
        ControlPosition, ControlMaterial, ControlFluid, ControlFluidWeights, NodePosition, NodeSponge, NodeWetting,
    ],
    writes: [
        FluidMobility, FluidHeld, FluidMoment, FluidRenormalisation, FluidRenormalisationBetween, ControlCompliance,
    ],
    oracle: crate::oracle::solid::moments,
    bound: 2e-5,
    twin: [
        pass("couple::solid_mobility", Fluid),
        pass("couple::solid_drawn", Controls),
        pass("couple::solid_compliance", Nodes),
        pass(NAME, Fluid),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(smoothing) = &params.solid else { return };
    mobilities(cpu, params, columns);
    compliances(cpu, params, columns);
    moments(cpu, params, smoothing, columns);
}

/// How much the drag leaves of a change of the velocity of every particle, and what it hands on.
fn mobilities(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let material = &columns.controls.material;
    let Fluid { velocity, controls: lists, control_weights, drag_rate, mobility, held, .. } =
        &mut columns.fluid;
    mobility.resize(velocity.len(), [0.0; 4]);
    held.resize(velocity.len(), [0.0; 4]);
    let mass = params.fluid.particle_mass;
    cpu.for_chunks((&mut mobility[..], &mut held[..]), |first, (mobility, held)| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..held.len()).step_by(LANES) {
                let group = lists.group(row);
                let mut share = one;
                let mut drawn = zero;
                if !group.is_empty() {
                    let [vx, vy, vz, _] = lanes::load_rows(simd, velocity, first + row);
                    let (u, inverse) = mean_inside(simd, material, group, &weights[lists.range(row)]);
                    let relative = minus([vx, vy, vz], u);
                    let [linear, inertial, _, _] = lanes::load_rows(simd, drag_rate, first + row);
                    let rate = (linear + inertial * dot(relative, relative).sqrt()) * params.step;
                    let rate = select(inverse.simd_gt(zero), rate, zero);
                    share = one / (one + rate);
                    drawn = rate * share * mass * inverse;
                }
                lanes::store_rows(mobility, row, [share, zero, zero, zero]);
                lanes::store_rows(held, row, [zero, zero, zero, drawn]);
            }
        });
    });
}

/// What nodes respond to impulses with.
fn compliances(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (held, nodes) = (&columns.fluid.held, &columns.nodes);
    let Controls { node, position, material, fluid: lists, fluid_weights, compliance, .. } =
        &mut columns.controls;
    compliance.clear();
    compliance.resize(position.len(), [0.0; 4]);
    cpu.for_chunks(&mut compliance[..], |first, compliance| {
        let (lists, weights) = (lists.chunk(first), fluid_weights.chunk(first));
        with_lanes!(cpu, simd => {
            for row in (0..compliance.len()).step_by(LANES) {
                let drawn = weighted(simd, held, lists.group(row), &weights[lists.range(row)]);
                lanes::store_rows(compliance, row, drawn);
            }
        });
        for (row, compliance) in compliance.iter_mut().enumerate() {
            let [.., drawn] = std::mem::take(compliance);
            let Some(node) = node.get(first + row).map(|node| *node as usize) else { continue };
            let volume = position[first + row][lane::controls::position::VOLUME];
            let response = response(params, nodes, (node, volume), drawn);
            let solid = material[first + row][lane::controls::material::VOLUME];
            *compliance = [response, drawn * response, 0.0, solid];
        }
    });
}

/// Sums over the nodes around every particle.
fn moments(cpu: &Cpu, params: &Params, smoothing: &Wendland, columns: &mut Columns) {
    let (fluid, controls) = (&mut columns.fluid, &columns.controls);
    let Fluid {
        position,
        controls: lists,
        control_weights,
        mobility,
        moment,
        renormalisation: along,
        renormalisation_between: between,
        ..
    } = fluid;
    for column in [&mut *moment, along, between] {
        column.resize(position.len(), [0.0; 4]);
    }
    let mass = params.fluid.particle_mass;
    let rows = ((&mut moment[..], &mut mobility[..]), (&mut along[..], &mut between[..]));
    cpu.for_chunks(rows, |first, ((moment, mobility), (along, between))| {
        let (lists, weights) = (lists.chunk(first), control_weights.chunk(first));
        with_lanes!(cpu, simd => {
            let kernel = smoothing.lanes(simd);
            let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
            for row in (0..moment.len()).step_by(LANES) {
                let group = lists.group(row);
                if group.is_empty() {
                    [&mut *moment, along, between].into_iter().for_each(|rows| rows[row..row + LANES].fill([0.0; 4]));
                    mobility[row..row + LANES].fill([1.0, 1.0, 0.0, 0.0]);
                    continue;
                }
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mirrors = Mirrors::near(params, &position[first + row..][..LANES]);
                let (mut sum, mut share, mut direct) = ([zero; 3], zero, zero);
                let (mut follows, mut chi) = (zero, zero);
                let mut second = Symmetric::splat(simd, 0.0);
                for (entry, weight) in group.iter().zip(&weights[lists.range(row)]) {
                    let [xa, ya, za, _] = lanes::gather_rows(simd, &controls.position, entry);
                    let [compliance, drawn, _, volume] = lanes::gather_rows(simd, &controls.compliance, entry);
                    let weight = lanes::load_array(simd, weight);
                    follows += weight * drawn;
                    chi += weight;
                    for mirror in mirrors.iter() {
                        let offset = minus(mirror.image(simd, [xa, ya, za]), [x, y, z]);
                        let u = kernel.closeness(dot(offset, offset));
                        let push = times(offset, volume * kernel.gradient_scale() * (u * u * u));
                        sum = plus(sum, push);
                        second.add_square(push, offset);
                        share += volume * kernel.shape(u);
                        direct += dot(push, push) * compliance;
                    }
                }
                let inverse = weight_inside(simd, chi);
                let [own, ..] = lanes::load_rows(simd, mobility, row);
                let with_nodes = own + (one - own) * (follows * inverse);
                let ([xx, yy, zz], [yz, zx, xy]) = (second.along, second.between);
                lanes::store_rows(mobility, row, [own, with_nodes, direct * (mass / 3.0), zero]);
                lanes::store_rows(moment, row, [sum[0], sum[1], sum[2], share * kernel.value_scale()]);
                lanes::store_rows(along, row, [xx, yy, zz, zero]);
                lanes::store_rows(between, row, [yz, zx, xy, zero]);
            }
        });
    });
}
