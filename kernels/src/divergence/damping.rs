//! Damping of velocities that differ from particle to particle, and of nothing that is longer than a few spacings.
//!
//! ```text
//! a_i -= q / h (F F v)_i,   q = min(0.3, 0.25 h c / d)
//! ```
//!
//! with the mean approach F of the neighbours (`divergence::approach`), the spacing d and the speed c of waves or of the flow. F is the
//! operator of the viscosity along the lines between particles, applied twice. Both momenta are kept, energy falls, and a flow of wave
//! number K is damped as `(K d)^4`. Particles in no order have nothing else by which to lose the energy of what they do to each other.
//! Bodies receive the opposite of what their images do.

use crate::{
    body::Wrench,
    columns::Columns,
    cpu::{Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    sph::obstacles::per_chunk,
    vector::{Vec3x8, times},
};

use super::{
    closing::Closing,
    image_rows::{Images, NO_BODY},
    reflect::{Twist, reflect, vector},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidNeighbors, FluidPairs, FluidApproach, FluidAcceleration, FluidImages, FluidPressureSolve,
        BodyStates, BodyFluidWrenches,
    ],
    writes: [FluidAcceleration, FluidImageVectors, BodyFluidWrenches],
    oracle: crate::oracle::divergence::damping,
    bound: 1e-5,
    twin: [
        pass("divergence::reflect", Images).from("still").on(&[
            ("values", "fluid_approach"),
            ("linear", "body_expected"),
            ("angular", "body_expected_spin"),
        ]),
        pass(NAME, Fluid).on(&[("values", "fluid_approach")]),
        pass("divergence::damping_bodies", FluidBesideBodies),
    ],
    constants: {
        /// Largest part of a difference that is damped in a step.
        const MAXIMUM_PART: f32 = 0.3;
        /// Part of it that is damped while a wave crosses a spacing.
        const PART_PER_CROSSING: f32 = 0.25;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(solve) = params.fluid.divergence() else { return };
    let count = columns.rows.fluid;
    let bodies = &columns.bodies.states.0;
    let fluid = &mut columns.fluid;
    let mut acceleration = std::mem::take(&mut fluid.acceleration);
    let mut vectors = std::mem::take(&mut fluid.image_vectors);
    let (values, at_rest) =
        ((&fluid.position[..], &fluid.approach[..]), vec![Twist::default(); bodies.len()]);
    reflect(cpu, &fluid.images, values, (bodies, &at_rest), &mut vectors);
    let crossing = params.step * fluid.pressure_solve.speed() / params.fluid.spacing;
    let part = (PART_PER_CROSSING * crossing).min(MAXIMUM_PART);
    let rate = part / (params.step * solve.lattice_moment);
    let closing = Closing { fluid, values: &fluid.approach, images: &vectors };
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    let mut wrenches = per_chunk(wrenches, acceleration.len(), bodies.len());
    cpu.for_chunks((&mut acceleration[..], PerChunk(&mut wrenches)), |first, (acceleration, wrenches)| {
        let used = count.saturating_sub(first).min(acceleration.len());
        let impulse = f64::from(params.fluid.particle_mass * params.step * rate);
        let mut reaction =
            Reaction { fluid_position: &fluid.position, bodies, impulse, wrenches: wrenches.0[0] };
        with_space!(cpu, params, simd, space => {
            for row in (0..used).step_by(LANES) {
                let sum = reaction.sums((simd, space), &closing, (first, row), used);
                let [sx, sy, sz] = times(sum, lanes::splat(simd, rate));
                let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
                lanes::store_rows(acceleration, row, [ax - sx, ay - sy, az - sz, aw]);
            }
        });
    });
    (fluid.acceleration, fluid.image_vectors) = (acceleration, vectors);
}

/// What bodies receive.
struct Reaction<'a, 'b> {
    fluid_position: &'a [[f32; 4]],
    bodies: &'a [crate::body::Body],
    impulse: f64,
    wrenches: &'b mut [Wrench],
}

impl Reaction<'_, '_> {
    #[inline(always)]
    fn sums<S: Simd>(
        &mut self,
        (simd, space): (S, impl Space<S>),
        closing: &Closing<'_>,
        (first, row): (usize, usize),
        used: usize,
    ) -> Vec3x8<S> {
        let images = &closing.fluid.images;
        let lanes_used = used.saturating_sub(row).min(LANES);
        closing.sums((simd, space), (first, row), |entry, part| {
            if images.has_bodies {
                self.add(images, (first + row, lanes_used), entry, part);
            }
        })
    }

    #[inline(always)]
    fn add<S: Simd>(
        &mut self,
        images: &Images,
        (row, lanes_used): (usize, usize),
        entry: &[u32; LANES],
        part: Vec3x8<S>,
    ) {
        for (lane, image) in entry.iter().enumerate().take(lanes_used) {
            let image = *image as usize;
            if image < images.count() && images.body[image] != NO_BODY {
                let body = images.body[image] as usize;
                let arm = vector(&self.fluid_position[row + lane]) - self.bodies[body].state.position;
                let part = glam::DVec3::new(part[0][lane].into(), part[1][lane].into(), part[2][lane].into());
                self.wrenches[body].add(part * self.impulse, arm.as_dvec3());
            }
        }
    }
}
