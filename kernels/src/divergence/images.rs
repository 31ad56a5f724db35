//! Rows of images: walls and bodies as mirrors of the particles near them, and the lists of neighbours between both.
//!
//! A particle has an image in every body nearer than 1.6 spacings (`mirror`). It and those have images by all combinations of the walls
//! nearer than the support radius: edges and corners are products. Images give density, pressure and velocities beside a wall what water
//! on both sides of it would.

use glam::Vec3;

use super::image_rows::{Image, Images, Mirrors};
use crate::{
    column::FAR_ROW,
    columns::{Columns, Fluid},
    cpu::{Cpu, PerChunk},
    grid::{
        cells::Domain,
        neighbors::{ListValues, Neighbors},
    },
    kernel::declare,
    lanes::{self, LANES},
    params::Params,
    periodic::{Space, with_space},
    sph::obstacles::near,
    vector::dot,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidCells, BodyStates],
    writes: [FluidImages],
    oracle: crate::oracle::divergence::images,
    bound: 4e-6,
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
        pass("divergence::near_images", Fluid).on(IMAGE_CELLS),
        pass("divergence::image_particles", Images).on(FLUID_CELLS),
        CHECK,
    ],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let bodies = &columns.bodies.states.0;
    let Fluid { position, cells, images, .. } = &mut columns.fluid;
    let radius = params.fluid.smoothing.support_radius;
    images.by_chunk.resize_with(position.len().div_ceil(crate::cpu::CHUNK), Vec::new);
    images.seekers.resize(position.len(), FAR_ROW);
    let rows = (&mut images.seekers[..], PerChunk(&mut images.by_chunk));
    cpu.for_chunks(rows, |first, (seekers, found)| {
        let found: &mut Vec<(u32, Image)> = &mut found.0[0];
        found.clear();
        seekers.fill(FAR_ROW);
        let rows = first..count.min(first + crate::cpu::CHUNK);
        let near = near(bodies, &position[rows.clone()], radius);
        let mirrors = Mirrors::new(params, bodies, &near);
        for row in rows {
            let [x, y, z, _] = position[row];
            let before = found.len();
            mirrors.visit(Vec3::new(x, y, z), |image| found.push((row as u32, image)));
            // Who has no image in a wall is too far away to see one.
            if found.len() > before || !near.is_empty() {
                seekers[row - first] = position[row];
            }
        }
    });
    images.collect(position, params);
    if images.count() == 0 {
        images.near.clear(position.len());
        images.particles.clear(0);
        return;
    }
    let used = images.count();
    let Images {
        position: at, near, pairs, particles, particle_pairs, in_bodies, has_bodies, seekers, ..
    } = images;
    let domain = match params.domain {
        Domain::Bounded { minimum, maximum } => {
            Domain::Bounded { minimum: minimum - radius, maximum: maximum + radius }
        }
        Domain::Unbounded => Domain::Unbounded,
    };
    images.cells.build(cpu, &at[..used], radius, domain);
    let reach = (radius, params.periodic.as_ref());
    near.build_in_order(cpu, (seekers, count), (at, used), &images.cells, reach);
    weigh(cpu, params, (position, near), (at, true), pairs);
    let rows = if *has_bodies { in_bodies.len() } else { 0 };
    particles.build(cpu, (&in_bodies[..rows], used.min(rows)), (position, count), cells, reach);
    weigh(cpu, params, (&at[..rows], particles), (position, false), particle_pairs);
}

/// The value of every pair: that of the image's volume, times the gradient of W over the distance vector.
fn weigh(
    cpu: &Cpu,
    params: &Params,
    (queries, lists): (&[[f32; 4]], &Neighbors),
    (targets, are_images): (&[[f32; 4]], bool),
    pairs: &mut ListValues,
) {
    let pairs = pairs.match_lists(lists);
    cpu.for_chunks(pairs, |first, pairs| {
        let (lists, pairs) = (lists.chunk(first), &mut pairs.0[0]);
        with_space!(cpu, params, simd, space => {
            let kernel = params.fluid.smoothing.lanes(simd);
            let gradient = kernel.gradient_scale() * params.fluid.rest_volume();
            let end = queries.len().min(first + crate::cpu::CHUNK);
            for row in (first..end).step_by(LANES) {
                let [x, y, z, own] = lanes::load_rows(simd, queries, row);
                let range = lists.range(row - first);
                for (entry, stored) in lists.group(row - first).iter().zip(&mut pairs[range]) {
                    let [xj, yj, zj, other] = lanes::gather_rows(simd, targets, entry);
                    let apart = space.apart([x, y, z], [xj, yj, zj]);
                    let u = kernel.closeness(dot(apart, apart));
                    let volume = if are_images { other } else { own };
                    lanes::store(stored, 0, gradient * (u * u * u) * volume);
                }
            }
        });
    });
}
