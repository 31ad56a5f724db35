//! Difference of the hydrostatic pressure between a particle and its image.
//!
//! ```text
//! d_g = 1/2 g . (x_g - x_s)
//! b_i = L_i sum_g d_g c_ig x_ig + sum_g' R_g'^T d_g' sum_j c_g'j L_j (x_g' - x_j)
//! ```
//!
//! over the images g in the list of the particle, and its own images g'. An image has the pressure of its particle, although it is higher
//! or lower by the weight of the water in between. This is what that lacks. The lattice at rest is exact with it. Without it pressures
//! alternate from layer to layer at a floor, and buoyancy is 4 % too large. Bodies receive the opposite.

use crate::{
    body::{Body, Wrench},
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd, prelude::*},
    params::Params,
    periodic::{Space, with_space},
    sph::obstacles::per_chunk,
    symmetric::Symmetric,
    vector::{Vec3x8, dot, plus, times},
    wrench,
};

use super::{
    image_rows::{ImageRows, NO_BODY},
    rate::Pushing,
    reflect::{react, vector},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidImages, FluidRenormalisation, FluidRenormalisationBetween, FluidImageRenormalisation,
        FluidImageRenormalisationBetween, FluidAcceleration, BodyStates,
    ],
    writes: [FluidAcceleration, FluidImageForce, BodyFluidWrenches],
    oracle: crate::oracle::divergence::hydrostatic,
    bound: 1e-5,
    twin: [
        pass("divergence::hydrostatic_images", ImagesOfBodies).on(&[("points", "fluid_position")]),
        pass(NAME, Fluid),
        pass("divergence::image_reaction", FluidBesideBodies).on(&[
            ("points", "fluid_position"),
            ("vectors", "fluid_acceleration"),
            ("wrenches", "body_fluid_wrenches"),
        ]),
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let fluid = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    wrench::begin(wrenches, fluid.position.len(), bodies.len());
    let mut force = std::mem::take(&mut fluid.image_force);
    let particles = Pushing {
        points: &fluid.position,
        along: &fluid.renormalisation,
        between: &fluid.renormalisation_between,
    };
    particles.on_images::<false>(cpu, params, &fluid.images, &mut force);
    let mut acceleration = std::mem::take(&mut fluid.acceleration);
    let mut wrenches = per_chunk(wrenches, acceleration.len(), bodies.len());
    let task = Task { params, bodies, fluid, force: &force };
    cpu.for_chunks((&mut acceleration[..], PerChunk(&mut wrenches)), |first, (acceleration, wrenches)| {
        let used = count.saturating_sub(first).min(acceleration.len());
        with_space!(cpu, params, simd, space => task.chunk((simd, space), first, acceleration));
        task.in_bodies(first, &mut acceleration[..used], wrenches.0[0]);
    });
    (fluid.acceleration, fluid.image_force) = (acceleration, force);
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    fluid: &'a Fluid,
    force: &'a ImageRows,
}

impl Task<'_> {
    /// Adds what images do that particles see.
    #[inline(always)]
    fn chunk<S: Simd>(&self, (simd, space): (S, impl Space<S>), first: usize, acceleration: &mut [[f32; 4]]) {
        for row in (0..acceleration.len()).step_by(LANES) {
            if self.fluid.images.near.chunk(first).group(row).is_empty() {
                continue;
            }
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            let [x, y, z] = plus(self.seen((simd, space), (first, row)), [ax, ay, az]);
            lanes::store_rows(acceleration, row, [x, y, z, aw]);
        }
    }

    /// By the images in the lists of eight particles; those in walls with their counterparts.
    #[inline(always)]
    fn seen<S: Simd>(&self, (simd, space): (S, impl Space<S>), (first, row): (usize, usize)) -> Vec3x8<S> {
        let Fluid { position, images, renormalisation, renormalisation_between, .. } = self.fluid;
        let mirrored = [&self.fluid.image_renormalisation.0, &self.fluid.image_renormalisation_between.0];
        let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
        let point = [x, y, z];
        let (mut own, mut others) = ([lanes::splat(simd, 0.0); 3], [lanes::splat(simd, 0.0); 3]);
        let zero = lanes::splat(simd, 0.0);
        for (entry, c) in images.seen(first, row) {
            let [hx, hy, hz, base] = lanes::gather_rows(simd, &images.lift, entry);
            let slope = [hx, hy, hz];
            // Walls along gravity lift nothing.
            if (dot(slope, slope) + base * base).simd_gt(zero).to_bitmask() == 0 {
                continue;
            }
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &images.position, entry);
            let push = times(space.apart(point, [xj, yj, zj]), lanes::load_array(simd, c));
            own = plus(own, times(push, -(dot(slope, [xj, yj, zj]) + base)));
            // Zero for images in bodies.
            let [xx, yy, zz, _] = lanes::gather_rows(simd, mirrored[0], entry);
            let [yz, zx, xy, _] = lanes::gather_rows(simd, mirrored[1], entry);
            let other = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
            others = plus(others, times(other.times(push), dot(slope, point) + base));
        }
        let [xx, yy, zz, _] = lanes::load_rows(simd, renormalisation, first + row);
        let [yz, zx, xy, _] = lanes::load_rows(simd, renormalisation_between, first + row);
        plus(Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] }.times(own), others)
    }

    /// Adds what particles receive through their images in bodies, and gives these the opposite.
    fn in_bodies(&self, first: usize, acceleration: &mut [[f32; 4]], wrenches: &mut [Wrench]) {
        let images = &self.fluid.images;
        if !images.has_bodies {
            return;
        }
        let scale = f64::from(self.params.fluid.particle_mass * self.params.step);
        for (row, acceleration) in acceleration.iter_mut().enumerate() {
            let point = vector(&self.fluid.position[first + row]);
            for image in images.of(first + row).filter(|image| images.body[*image] != NO_BODY) {
                let force = vector(&self.force.0[image]);
                let back = images.back(image, force);
                (0..3).for_each(|axis| acceleration[axis] += back[axis]);
                react(images, self.bodies, (image, point), (force, back), scale, wrenches);
            }
        }
    }
}
