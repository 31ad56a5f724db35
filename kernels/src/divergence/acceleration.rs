//! Iteration of the pressure solve: acceleration of particles and bodies by the pressure.
//!
//! ```text
//! T_r = sum_j c_rj P_j L_j (x_r - x_j)                     r: particles, and images in bodies
//! a_i = T_i + P_i B_i + sum_g c_ig P_s Q L_s Q (x_i - x_g) + sum_g' R_g' Q_g' T_g'
//! ```
//!
//! over the images g in walls, and the own images g' in bodies. It is the transpose of the divergence, images and bodies included: images
//! in walls mirror the pressure of their particle, which is the same by symmetry and needs no pass over images. What an image in a body
//! receives, less what it hands on to its particle, acts on the body. Momentum is exact after any number of rounds.

use glam::Vec3;

use crate::{
    body::Wrench,
    columns::{BodyStore, Columns, Fluid},
    cpu::{CHUNK, Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::with_space,
    sph::obstacles::per_chunk,
    vector::{plus, times},
};

use super::{
    image_rows::{ImageRows, Images, NO_BODY},
    rate::Push,
    reflect::{mirrored_renormalisation, react, vector},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPredicted, FluidNeighbors, FluidPairs, FluidFactors, FluidRenormalisation, FluidRenormalisationBetween, FluidImages,
        BodyStates,
    ],
    writes: [
        FluidCorrection, FluidImageStress, FluidImageStressBetween, BodyPressureWrenches, BodyAcceleration, BodyAngularAcceleration,
    ],
    oracle: crate::oracle::divergence::acceleration,
    bound: 1e-5,
    twin: [],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let (fluid, store) = (&mut columns.fluid, &mut columns.bodies);
    let mut stress =
        [std::mem::take(&mut fluid.image_stress), std::mem::take(&mut fluid.image_stress_between)];
    on_images(cpu, params, fluid, &mut stress);
    [fluid.image_stress, fluid.image_stress_between] = stress;
    let mut correction = std::mem::take(&mut fluid.correction);
    correction.resize(fluid.predicted.len(), [0.0; 4]);
    let push = Push { fluid };
    let BodyStore { states, pressure_wrenches, .. } = store;
    let bodies = &states.0;
    pressure_wrenches.0.clear();
    pressure_wrenches.0.resize(correction.len().div_ceil(CHUNK) * bodies.len(), Wrench::default());
    let mut wrenches = per_chunk(&mut pressure_wrenches.0, correction.len(), bodies.len());
    cpu.for_chunks((&mut correction[..], PerChunk(&mut wrenches)), |first, (correction, wrenches)| {
        let (lists, pairs) = (fluid.neighbors.chunk(first), fluid.pairs.chunk(first));
        with_space!(cpu, params, simd, space => {
            for row in (0..correction.len()).step_by(LANES) {
                let [x, y, z, pressure] = lanes::load_rows(simd, &fluid.predicted, first + row);
                let [bx, by, bz, _] = lanes::load_rows(simd, &fluid.factors, first + row);
                let (point, list) = ([x, y, z], lists.group(row));
                let sum = push.by_particles((simd, space), point, list, &pairs[lists.range(row)]);
                let sum = plus(sum, push.by_images((simd, space), (first, row), point));
                let [x, y, z] = plus(sum, times([bx, by, bz], pressure));
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
                    let force = vector(&fluid.image_stress.0[image]);
                    let back = fluid.images.back(image, force);
                    (0..3).for_each(|axis| correction[axis] += back[axis]);
                    react(&fluid.images, bodies, (image, point), (force, back), scale, wrenches.0[0]);
                }
            }
        }
    });
    fluid.correction = correction;
    accelerate(params, store);
}

/// Stress of the images in walls, acceleration of those in bodies.
fn on_images(cpu: &Cpu, params: &Params, fluid: &Fluid, [along, between]: &mut [ImageRows; 2]) {
    let images: &Images = &fluid.images;
    let push = Push { fluid };
    let rows = images.position.len();
    along.0.resize(rows, [0.0; 4]);
    between.0.resize(rows, [0.0; 4]);
    let renormalisation = [&fluid.renormalisation[..], &fluid.renormalisation_between[..]];
    cpu.for_chunks((&mut along.0[..], &mut between.0[..]), |first, (along, between)| {
        let used = images.count().saturating_sub(first).min(along.len());
        along[used..].fill([0.0; 4]);
        between[used..].fill([0.0; 4]);
        for row in 0..used {
            let image = first + row;
            if images.body[image] == NO_BODY {
                let [.., pressure] = fluid.predicted[images.source[image] as usize];
                let ([xx, yy, zz, _], [yz, zx, xy, _]) =
                    mirrored_renormalisation(images, image, renormalisation);
                along[row] = [pressure * xx, pressure * yy, pressure * zz, 1.0];
                between[row] = [pressure * yz, pressure * zx, pressure * xy, 0.0];
            } else {
                between[row] = [0.0; 4];
            }
        }
        if !images.has_bodies {
            return;
        }
        let (lists, pairs) = (images.particles.chunk(first), images.particle_pairs.chunk(first));
        with_space!(cpu, params, simd, space => {
            for row in (0..along.len()).step_by(LANES) {
                let list = lists.group(row);
                let [x, y, z, _] = lanes::load_rows(simd, &images.position, first + row);
                let [x, y, z] = push.by_particles((simd, space), [x, y, z], list, &pairs[lists.range(row)]);
                let mut forces = [[0.0; 4]; LANES];
                lanes::store_rows(&mut forces, 0, [x, y, z, lanes::splat(simd, 0.0)]);
                for (lane, force) in forces.iter().enumerate().take(used.saturating_sub(row).min(LANES)) {
                    if images.body[first + row + lane] != NO_BODY {
                        along[row + lane] = *force;
                    }
                }
            }
        });
    });
}

/// Accelerations of the bodies.
fn accelerate(params: &Params, store: &mut BodyStore) {
    let count = store.states.0.len();
    store.acceleration.resize(count, [0.0; 4]);
    store.angular_acceleration.resize(count, [0.0; 4]);
    for (index, body) in store.states.0.iter().enumerate() {
        let received = store.pressure_wrenches.total(index, count);
        let over_step = |vector: Vec3| {
            let [x, y, z] = (vector / params.step).to_array();
            [x, y, z, 0.0]
        };
        store.acceleration[index] = over_step(body.inverse_mass * received.impulse.as_vec3());
        store.angular_acceleration[index] =
            over_step(body.inverse_inertia * received.angular_impulse.as_vec3());
    }
}
