//! Iteration of the pressure solve: velocities of particles and bodies by the pressure.
//!
//! ```text
//! T_r = sum_j c_rj P_j L_j (x_r - x_j)                     r: particles, and images in bodies
//! a_i = T_i + P_i B_i + sum_g c_ig P_s Q L_s Q (x_i - x_g) + sum_g' R_g'^T T_g',   w_i = v_i + h a_i
//! ```
//!
//! over the images g in walls, and the own images g' in bodies. It is the transpose of the divergence, images and bodies included. Images
//! in walls mirror the pressure of their particle, which is the same by symmetry and needs no pass over images. What an image in a body
//! receives, less what it hands on to its particle, acts on the body. Momentum is exact after any number of rounds.

use glam::Vec3;

use crate::{
    columns::{BodyStore, Columns},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::with_space,
    sph::obstacles::per_chunk,
    vector::{plus, times},
    wrench,
};

use super::{
    image_rows::NO_BODY,
    rate::Pushing,
    reflect::{react, vector},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPredicted, FluidVelocity, FluidNeighbors, FluidPairs, FluidFactors, FluidRenormalisation, FluidRenormalisationBetween,
        FluidImages, FluidImagePredicted, FluidImageRenormalisation, FluidImageRenormalisationBetween, BodyStates, BodyExpected,
        BodyExpectedSpin,
    ],
    writes: [FluidCorrection, FluidImageForce, BodyPressureWrenches, BodySolved, BodySolvedSpin],
    oracle: crate::oracle::divergence::acceleration,
    bound: 1e-5,
    twin: [
        pass("divergence::acceleration_images", ImagesOfBodies).on(&[("points", "fluid_predicted")]),
        pass(NAME, Fluid),
        pass("divergence::acceleration_walls", Fluid),
        pass("divergence::image_reaction", FluidBesideBodies).from("push").on(&[
            ("points", "fluid_predicted"),
            ("vectors", "fluid_correction"),
            ("wrenches", "body_pressure_wrenches"),
        ]),
        pass("divergence::push_bodies", Bodies).on(&[("wrenches", "body_pressure_wrenches")]),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let (fluid, store) = (&mut columns.fluid, &mut columns.bodies);
    let mut force = std::mem::take(&mut fluid.image_force);
    let mut correction = std::mem::take(&mut fluid.correction);
    correction.resize(fluid.predicted.len(), [0.0; 4]);
    let particles = Pushing {
        points: &fluid.predicted,
        along: &fluid.renormalisation,
        between: &fluid.renormalisation_between,
    };
    particles.on_images::<true>(cpu, params, &fluid.images, &mut force);
    let images = Pushing {
        points: &fluid.image_predicted.0,
        along: &fluid.image_renormalisation.0,
        between: &fluid.image_renormalisation_between.0,
    };
    let BodyStore { states, pressure_wrenches, .. } = store;
    let bodies = &states.0;
    wrench::begin(&mut pressure_wrenches.0, correction.len(), bodies.len());
    let mut wrenches = per_chunk(&mut pressure_wrenches.0, correction.len(), bodies.len());
    cpu.for_chunks((&mut correction[..], PerChunk(&mut wrenches)), |first, (correction, wrenches)| {
        let (lists, pairs) = (fluid.neighbors.chunk(first), fluid.pairs.chunk(first));
        with_space!(cpu, params, simd, space => {
            let step = lanes::splat(simd, params.step);
            for row in (0..correction.len()).step_by(LANES) {
                let [x, y, z, pressure] = lanes::load_rows(simd, &fluid.predicted, first + row);
                let [bx, by, bz, _] = lanes::load_rows(simd, &fluid.factors, first + row);
                let [vx, vy, vz, _] = lanes::load_rows(simd, &fluid.velocity, first + row);
                let list = lists.group(row).iter().zip(&pairs[lists.range(row)]);
                let sum = particles.sum::<_, true>((simd, space), [x, y, z], list);
                let seen = images.sum::<_, true>((simd, space), [x, y, z], fluid.images.seen(first, row));
                let sum = plus(plus(sum, seen), times([bx, by, bz], pressure));
                let [x, y, z] = plus([vx, vy, vz], times(sum, step));
                lanes::store_rows(correction, row, [x, y, z, lanes::splat(simd, 0.0)]);
            }
        });
        if fluid.images.has_bodies {
            let used = count.saturating_sub(first).min(correction.len());
            let scale = f64::from(params.fluid.particle_mass * params.step);
            for (row, correction) in correction[..used].iter_mut().enumerate() {
                let point = vector(&fluid.predicted[first + row]);
                for image in fluid.images.of(first + row).filter(|image| fluid.images.body[*image] != NO_BODY)
                {
                    let force = vector(&force.0[image]);
                    let back = fluid.images.back(image, force);
                    (0..3).for_each(|axis| correction[axis] += params.step * back[axis]);
                    react(&fluid.images, bodies, (image, point), (force, back), scale, wrenches.0[0]);
                }
            }
        }
    });
    (fluid.correction, fluid.image_force) = (correction, force);
    push_bodies(store);
}

/// Velocities of the bodies.
fn push_bodies(store: &mut BodyStore) {
    let count = store.states.0.len();
    store.solved.resize(count, [0.0; 4]);
    store.solved_spin.resize(count, [0.0; 4]);
    for (index, body) in store.states.0.iter().enumerate() {
        let received = store.pressure_wrenches.total(index, count);
        let moved = |expected: &[f32; 4], change: Vec3| {
            let [x, y, z] = (vector(expected) + change).to_array();
            [x, y, z, 0.0]
        };
        let (linear, angular) = (received.impulse.as_vec3(), received.angular_impulse.as_vec3());
        store.solved[index] = moved(&store.expected[index], body.inverse_mass * linear);
        store.solved_spin[index] = moved(&store.expected_spin[index], body.inverse_inertia * angular);
    }
}
