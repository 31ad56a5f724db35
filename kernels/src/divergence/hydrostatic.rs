//! Difference of the hydrostatic pressure between a particle and its image.
//!
//! ```text
//! d_g = 1/2 g . (x_g - x_s)
//! b_i = L_i sum_g d_g c_ig x_ig + sum_g' R_g'^T d_g' sum_j c_g'j L_j (x_g' - x_j)
//! ```
//!
//! over the images g in the list of the particle, and its own images g'. An image has the pressure of its particle, although it is higher
//! or lower by the weight of the water in between: this is what that lacks. The lattice at rest is exact with it. Without it pressures
//! alternate from layer to layer at a floor, and buoyancy is 4 % too large. Bodies receive the opposite.

use glam::Vec3;

use crate::{
    body::{Body, Wrench},
    columns::{Columns, Fluid},
    cpu::{CHUNK, Cpu, PerChunk},
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::Params,
    periodic::{Space, with_space},
    sph::obstacles::per_chunk,
    vector::{Vec3x8, plus, splat, times},
};

use super::{
    image_rows::{Images, NO_BODY},
    reflect::{mirrored_renormalisation, react, vector},
    symmetric::Symmetric,
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidImages, FluidRenormalisation, FluidRenormalisationBetween, FluidAcceleration, BodyStates,
    ],
    writes: [FluidAcceleration, BodyFluidWrenches],
    oracle: crate::oracle::divergence::hydrostatic,
    bound: 1e-5,
    twin: [],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.divergence().is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { position, images, renormalisation, renormalisation_between, acceleration, .. } =
        &mut columns.fluid;
    let bodies = &columns.bodies.states.0;
    let wrenches = &mut columns.bodies.fluid_wrenches.0;
    wrenches.clear();
    wrenches.resize(position.len().div_ceil(CHUNK) * bodies.len(), Wrench::default());
    if images.count() == 0 {
        return;
    }
    let mut wrenches = per_chunk(wrenches, position.len(), bodies.len());
    let renormalisation = [&renormalisation[..], &renormalisation_between[..]];
    let gravity = along_open_axes(params);
    let task = Task { params, gravity, bodies, position, images, renormalisation };
    cpu.for_chunks((&mut acceleration[..], PerChunk(&mut wrenches)), |first, (acceleration, wrenches)| {
        let used = count.saturating_sub(first).min(acceleration.len());
        with_space!(cpu, params, simd, space =>
            task.chunk((simd, space), (first, used), acceleration, wrenches.0[0]));
    });
}

/// Gravity without its part along axes on which space repeats: there is no bottom.
fn along_open_axes(params: &Params) -> Vec3 {
    let periods = params.periodic.map_or(Vec3::ZERO, |periodic| periodic.periods());
    Vec3::select(periods.cmpgt(Vec3::ZERO), Vec3::ZERO, params.gravity)
}

struct Task<'a> {
    params: &'a Params,
    gravity: Vec3,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    images: &'a Images,
    renormalisation: [&'a [[f32; 4]]; 2],
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        (first, used): (usize, usize),
        acceleration: &mut [[f32; 4]],
        wrenches: &mut [Wrench],
    ) {
        let (lists, pairs) = (self.images.near.chunk(first), self.images.pairs.chunk(first));
        for row in (0..acceleration.len()).step_by(LANES) {
            let list = lists.group(row);
            let lanes_used = used.saturating_sub(row).min(LANES);
            if list.is_empty() {
                continue;
            }
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let pairs = &pairs[lists.range(row)];
            let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
            let sum = self.seen((simd, space), first + row, [x, y, z], (list, pairs));
            let [sx, sy, sz] = plus(sum, [ax, ay, az]);
            let mut stored = [[0.0; 4]; LANES];
            lanes::store_rows(&mut stored, 0, [sx, sy, sz, aw]);
            acceleration[row..row + lanes_used].copy_from_slice(&stored[..lanes_used]);
        }
        if self.images.has_bodies {
            for (row, acceleration) in acceleration[..used].iter_mut().enumerate() {
                self.in_bodies((simd, space), first + row, acceleration, wrenches);
            }
        }
    }

    /// By the images in the lists of eight particles; those in walls with their counterparts.
    #[inline(always)]
    fn seen<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        row: usize,
        point: Vec3x8<S>,
        (list, pairs): (&[[u32; LANES]], &[[f32; LANES]]),
    ) -> Vec3x8<S> {
        let points: [Vec3; LANES] = std::array::from_fn(|lane| vector(&self.position[row + lane]));
        let mut own = [lanes::splat(simd, 0.0); 3];
        let mut mirrored = own;
        for (entry, c) in list.iter().zip(pairs) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &self.images.position, entry);
            let push = times(space.apart(point, [xj, yj, zj]), lanes::load_array(simd, c));
            let (mut of_image, mut of_particle) = ([0.0; LANES], [0.0; LANES]);
            let (mut along, mut between) = ([[0.0; 4]; LANES], [[0.0; 4]; LANES]);
            for (lane, image) in entry.iter().enumerate() {
                let image = *image as usize;
                if image >= self.images.count() {
                    continue;
                }
                of_image[lane] = self.difference(image);
                if self.images.body[image] == NO_BODY {
                    of_particle[lane] = self.of_own(image, points[lane]);
                    (along[lane], between[lane]) =
                        mirrored_renormalisation(self.images, image, self.renormalisation);
                }
            }
            own = plus(own, times(push, lanes::load_array(simd, &of_image)));
            let [xx, yy, zz, _] = lanes::load_rows(simd, &along, 0);
            let [yz, zx, xy, _] = lanes::load_rows(simd, &between, 0);
            let other = Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] };
            mirrored = plus(mirrored, times(other.times(push), lanes::load_array(simd, &of_particle)));
        }
        let [xx, yy, zz, _] = lanes::load_rows(simd, self.renormalisation[0], row);
        let [yz, zx, xy, _] = lanes::load_rows(simd, self.renormalisation[1], row);
        plus(Symmetric { along: [xx, yy, zz], between: [yz, zx, xy] }.times(own), mirrored)
    }

    /// d of an image.
    fn difference(&self, image: usize) -> f32 {
        let source = self.images.source[image] as usize;
        let (at, of) = (vector(&self.images.position[image]), vector(&self.position[source]));
        0.5 * self.gravity.dot(at - of)
    }

    /// d of the image that a particle has in the walls of another image.
    fn of_own(&self, image: usize, point: Vec3) -> f32 {
        let signs = self.images.signs(image);
        let walls = vector(&self.images.position[image]) - signs * vector(&self.images.foot[image]);
        0.5 * self.gravity.dot(walls + (signs - 1.0) * point)
    }

    /// Adds what a particle receives through its images in bodies, and gives these the opposite.
    #[inline(always)]
    fn in_bodies<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        row: usize,
        acceleration: &mut [f32; 4],
        wrenches: &mut [Wrench],
    ) {
        let scale = f64::from(self.params.fluid.particle_mass * self.params.step);
        for image in self.images.of(row).filter(|image| self.images.body[*image] != NO_BODY) {
            let list = (&self.images.particles, &self.images.particle_pairs);
            let force = self.on_image((simd, space), image, list) * self.difference(image);
            let back = self.images.back(image, force);
            (0..3).for_each(|axis| acceleration[axis] += back[axis]);
            react(
                self.images,
                self.bodies,
                (image, vector(&self.position[row])),
                (force, back),
                scale,
                wrenches,
            );
        }
    }

    /// `sum_j c_gj L_j (x_g - x_j)`.
    #[inline(always)]
    fn on_image<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        image: usize,
        (lists, pairs): (&crate::grid::neighbors::Neighbors, &crate::grid::neighbors::ListValues),
    ) -> Vec3 {
        let (group, lane) = (image % CHUNK / LANES * LANES, image % LANES);
        let (chunk, values) = (lists.chunk(image), pairs.chunk(image));
        let [x, y, z, _] = self.images.position[image];
        let point = splat(simd, [x, y, z]);
        let mut sum = Vec3::ZERO;
        for (entry, c) in chunk.group(group).iter().zip(&values[chunk.range(group)]) {
            let j = entry[lane] as usize;
            let [xj, yj, zj, _] = self.position[j];
            let apart = space.apart(point, splat(simd, [xj, yj, zj]));
            let apart = Vec3::new(apart[0][0], apart[1][0], apart[2][0]);
            let [[xx, yy, zz, _], [yz, zx, xy, _]] = [self.renormalisation[0][j], self.renormalisation[1][j]];
            sum += c[lane]
                * Vec3::new(
                    xx * apart.x + xy * apart.y + zx * apart.z,
                    xy * apart.x + yy * apart.y + yz * apart.z,
                    zx * apart.x + yz * apart.y + zz * apart.z,
                );
        }
        sum
    }
}
