//! Rows of images: walls and bodies as mirrors of the particles near them, and the lists of neighbours between both.
//!
//! A particle has an image in every body nearer than 1.6 spacings (`mirror`), of a compound in every part whose surface it sees.
//! It and those have images by all combinations of the walls nearer than the support radius: edges and corners are products. Images give
//! density, pressure and velocities beside a wall what water on both sides of it would.
//!
//! The moments of the neighbourhoods begin at zero; `couple::solid_moments` adds the material of sponges.

use super::{image_rows::Images, near::Seekers};
use crate::{
    columns::{Columns, Fluid},
    cpu::{CHUNK, Cpu},
    grid::neighbors::{ListValues, Neighbors},
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::{Space, with_space},
    vector::dot,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidNeighbors, FluidCells, BodyStates],
    writes: [FluidImages, FluidMoment, FluidRenormalisation, FluidRenormalisationBetween],
    oracle: crate::oracle::divergence::images,
    bound: 1e-5,
    twin_writes: [FluidExtremes],
    twin: [
        pass("divergence::images_count", Fluid),
        pass("grid::scan_sums", ImageLineScan).on(IMAGE_LINE),
        pass("grid::scan_pages", ImageLinePages).on(IMAGE_LINE),
        pass("divergence::images_total", One),
        pass(NAME, Fluid),
        pass("grid::count", Images).on(IMAGE_CELLS),
        pass("grid::scan_sums", ImageScan).on(IMAGE_CELLS),
        pass("grid::scan_pages", ImagePages).on(IMAGE_CELLS),
        pass("grid::scatter", Images).on(IMAGE_CELLS),
        pass("divergence::image_order", Images).on(IMAGE_CELLS),
        pass("divergence::near_images", Fluid).on(&[
            ("grid", "image_grid"),
            ("starts", "image_starts"),
            ("targets", "image_position"),
            ("list", "fluid_near_images"),
        ]),
        pass("divergence::image_particles", ImagesOfBodies).on(&[
            ("grid", "fluid_grid"),
            ("starts", "fluid_starts"),
            ("targets", "fluid_position"),
            ("list", "image_particles"),
        ]),
        CHECK,
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let bodies = &columns.bodies.states.0;
    let fluid = &mut columns.fluid;
    for moment in [&mut fluid.moment, &mut fluid.renormalisation, &mut fluid.renormalisation_between] {
        moment.clear();
        moment.resize(fluid.position.len(), [0.0; 4]);
    }
    let Fluid { position, neighbors, cells, images, .. } = fluid;

    images.find(cpu, params, (position, count), bodies);

    let mut of_bodies = std::mem::take(&mut images.of_bodies);
    if images.has_bodies {
        of_bodies.search(cpu, params, (position, count), images);
    }
    let seekers = Seekers { params, position, count, neighbors };
    seekers.find(cpu, images, images.has_bodies.then_some(&of_bodies));
    images.of_bodies = of_bodies;

    let used = images.count();
    let Images { position: at, particles, particle_pairs, in_bodies, .. } = images;
    let reach = (params.fluid.smoothing.support_radius, params.periodic.as_ref());
    particles.build(cpu, (in_bodies, used.min(in_bodies.len())), (position, count), cells, reach);
    weigh(cpu, params, (at, particles), position, particle_pairs);
}

/// The value of every pair: that of the image's volume, times the gradient of W over the distance vector.
fn weigh(
    cpu: &Cpu,
    params: &Params,
    (images, lists): (&[[f32; 4]], &Neighbors),
    particles: &[[f32; 4]],
    pairs: &mut ListValues,
) {
    let pairs = pairs.match_lists(lists);
    cpu.for_chunks(pairs, |first, pairs| {
        let (lists, pairs) = (lists.chunk(first), &mut pairs.0[0]);
        with_space!(cpu, params, simd, space => {
            let kernel = params.fluid.smoothing.lanes(simd);
            let gradient = kernel.gradient_scale() * params.fluid.rest_volume();
            let end = images.len().min(first + CHUNK);
            for row in (first..end).step_by(LANES) {
                let [x, y, z, volume] = lanes::load_rows(simd, images, row);
                let range = lists.range(row - first);
                for (entry, stored) in lists.group(row - first).iter().zip(&mut pairs[range]) {
                    let [xj, yj, zj, _] = lanes::gather_rows(simd, particles, entry);
                    let apart = space.apart([x, y, z], [xj, yj, zj]);
                    let u = kernel.closeness(dot(apart, apart));
                    lanes::store(stored, 0, gradient * (u * u * u) * volume);
                }
            }
        });
    });
}
