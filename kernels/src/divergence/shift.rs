//! Shift of particles towards where particles are missing, in water that is full: their arrangement stays even.
//!
//! ```text
//! x_i -= 1/5 d^2 max(0, 1 - 2 |z_i| / z_1) z_i, at most d / 10
//! ```
//!
//! It carries no momentum. Near a body it is along the surface alone. It comes after the drag, whose weights belong to the places of
//! the beginning of the step.

use crate::{
    body::{Body, BodyState, Compound, Shape},
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::Params,
};

use super::{
    image_rows::{Images, NO_BODY},
    rate::{MINIMUM_MATERIAL, SPARSE},
    reflect::vector,
};
use glam::Vec3;

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidMoment, FluidRenormalisation, FluidImages, BodyStates],
    writes: [FluidPosition],
    oracle: crate::oracle::divergence::shift,
    // A shift is a small difference of large coordinates.
    bound: 2e-4,
    twin: [pass(NAME, Fluid)],
    constants: {
        /// Shift over the square of the spacing and the first moment.
        const SHIFT: f32 = 0.2;
        /// Largest shift over the spacing.
        const MAXIMUM_SHIFT: f32 = 0.1;
        /// First moment over that at a flat surface at which there is none any more.
        const SHIFT_END: f32 = 0.5;
        /// Distance from a body over the spacing within which the shift is along its surface.
        const SHIFT_ALONG: f32 = 2.0;
        /// Distance from a part of a compound over the spacing within which there is no shift towards it.
        const SHIFT_CLEARANCE: f32 = 0.3;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(divergence) = params.fluid.divergence() else { return };
    let count = columns.rows.fluid;
    let Fluid { position, moment, renormalisation, images, .. } = &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let has_images = images.has_bodies;
    let spacing = params.fluid.spacing;
    cpu.for_chunks(&mut position[..], |first, position| {
        let used = count.saturating_sub(first).min(position.len());
        for (row, x) in position[..used].iter_mut().enumerate() {
            let at = first + row;
            let is_active = renormalisation[at][lane::fluid::renormalisation::DENSITY] >= SPARSE;
            // Drag keeps particles in pores where they are.
            if !is_active || moment[at][lane::fluid::moment::MATERIAL] > MINIMUM_MATERIAL {
                continue;
            }
            let z = vector(&moment[at]);
            let share = 1.0 - z.length() / (SHIFT_END * divergence.surface_moment);
            let mut shift = -SHIFT * spacing * spacing * share.max(0.0) * z;
            if has_images {
                shift = along_bodies(shift, (images, at), (bodies, vector(x)), spacing);
            }
            let shift = shift.clamp_length_max(MAXIMUM_SHIFT * spacing);
            (0..3).for_each(|axis| x[axis] += shift[axis]);
        }
    });
}

/// The part of a shift along the bodies that the particle has an image in.
fn along_bodies(
    mut shift: Vec3,
    (images, row): (&Images, usize),
    (bodies, point): (&[Body], Vec3),
    spacing: f32,
) -> Vec3 {
    let mut last = NO_BODY;
    for image in images.of(row) {
        let body = images.body[image];
        if body == NO_BODY || body == last {
            continue;
        }
        last = body;
        let (distance, normal) = bodies[body as usize].distance_and_normal(point);
        if distance < SHIFT_ALONG * spacing {
            shift -= shift.dot(normal) * normal;
        }
        if let Shape::Compound(compound) = &bodies[body as usize].shape {
            shift = beside_parts(shift, compound, &bodies[body as usize].state, point, spacing);
        }
    }
    shift
}

/// The part of a shift that leads into none of the parts of a compound: edges between them have no normal of their own.
fn beside_parts(shift: Vec3, compound: &Compound, state: &BodyState, point: Vec3, spacing: f32) -> Vec3 {
    let inverse = state.rotation.conjugate();
    let local = inverse * (point - state.position);
    let mut along = inverse * shift;
    for is_again in [false, true] {
        for part in &compound.parts {
            let (distance, normal) = part.distance_and_normal(local);
            let into = along.dot(normal);
            if distance < SHIFT_CLEARANCE * spacing && into < 0.0 {
                along = if is_again { Vec3::ZERO } else { along - into * normal };
            }
        }
    }
    state.rotation * along
}
