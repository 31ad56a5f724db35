//! Moments of the neighbourhoods, once a step, and the divergence that errors of the density ask for.
//!
//! ```text
//! c_ij = J_j V (-dW/dr) / r,   e_ij = x_j - x_i
//! f_i = V sum_j J_j W_ij,   z_i = sum_j c_ij e_ij,   M_i = sum_j c_ij e_ij e_ij^T      images included
//! L_i = M_i^-1                                                                       renormalisation [RL96; BL99]
//! D_i = |-L_i z_i + sum_g R_g^T c_ig L_i e_ig|^2 + sum_j |c_ij L_i e_ij|^2           diagonal; g the own images of i
//! e_i = f_i - 1 + k max(0, (|z_i| / z_1 - 1/4) / (3/4))                              error of the density
//! h t_i = clamp(e_i, 1/4) / 5
//! ```
//!
//! **Why L.** With it the divergence of velocities that are linear in the position is exact, whatever the arrangement of the particles,
//! and the force by its transpose keeps energy and both momenta. Without it pairs under a uniform pressure carry shear stress, as in a
//! pile of spheres, and bodies stick in water (docs/history.md). Where M is far from that of a lattice, L is that of a neighbourhood in
//! between.
//!
//! **Surfaces.** z is zero inside, `z_1` in the first layer of a lattice below a flat surface, which lacks k of its neighbours. There the
//! error is zero as well, so that a surface is neither drawn together nor blown up.
//!
//! An error is put right within five steps. If all of a pool would be thrown by that, the target is scaled down (`pressure_solve`).

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select},
    params::{Divergence, Params},
    periodic::{Space, with_space},
    sph::pressure_solve::Beginning,
    vector::{Vec3x8, dot, negative, plus, times},
};

use super::{image_rows::Images, reflect::vector, symmetric::Symmetric};

declare! {
    needs: [Fluid, Divergence],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors, FluidImages],
    writes: [
        FluidPairs, FluidRenormalisation, FluidRenormalisationBetween, FluidMoment, FluidPressureSolve,
    ],
    oracle: crate::oracle::divergence::moments,
    bound: 1e-5,
    twin: [],
    constants: {
        /// Largest deviation of the second moment from that of a lattice, as a norm, that is corrected in full.
        const MAXIMUM_DEVIATION: f32 = 0.7;
        /// Smallest diagonal, over the inverse of the squared spacing.
        const MINIMUM_DIAGONAL: f32 = 1.0e-3;
        /// First moment over that at a flat surface from which on neighbours are missing for good.
        const SURFACE_BEGIN: f32 = 0.25;
        /// Error of the density that is none.
        const DEAD_ZONE: f32 = 1.0e-3;
        /// Largest error that is put right.
        const MAXIMUM_ERROR: f32 = 0.25;
        /// Steps in which it is.
        const CORRECTION_STEPS: f32 = 5.0;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(divergence) = params.fluid.divergence() else { return };
    let count = columns.rows.fluid;
    let Fluid {
        position,
        velocity,
        neighbors,
        images,
        pairs,
        renormalisation,
        renormalisation_between,
        moment,
        pressure_solve,
        ..
    } = &mut columns.fluid;
    for column in [&mut *renormalisation, renormalisation_between, moment] {
        column.resize(position.len(), [0.0; 4]);
    }
    let task = Task { params, divergence, position, images };
    let rows = (
        (&mut renormalisation[..], &mut renormalisation_between[..]),
        &mut moment[..],
        pairs.match_lists(neighbors),
        pressure_solve.beginnings(position.len()),
    );
    cpu.for_chunks(rows, |first, ((along, between), moment, pairs, beginning)| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            task.chunk((simd, space), first, lists, &mut pairs.0[0], [along, between, moment]));
        // Padding rows must not move and must not push.
        let used = count.saturating_sub(first).min(along.len());
        [&mut *along, between, moment].into_iter().for_each(|rows| rows[used..].fill([0.0; 4]));
        beginning.0[0] = Beginning::of(&velocity[first..first + used], between);
    });
    pressure_solve.begin_divergence(count, params);
}

/// Sums over neighbours and images.
#[derive(Clone, Copy)]
struct Sums<S: Simd> {
    first: Vec3x8<S>,
    second: Symmetric<S>,
    shape: f32x8<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn add(&mut self, c: f32x8<S>, offset: Vec3x8<S>, shape: f32x8<S>) {
        let push = times(offset, c);
        self.first = plus(self.first, push);
        self.second.add_product(push, offset);
        self.shape += shape;
    }
}

struct Task<'a> {
    params: &'a Params,
    divergence: &'a Divergence,
    position: &'a [[f32; 4]],
    images: &'a Images,
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        first: usize,
        lists: &ChunkLists,
        pairs: &mut [[f32; LANES]],
        [along, between, moment]: [&mut [[f32; 4]]; 3],
    ) {
        let fluid = &self.params.fluid;
        let kernel = fluid.smoothing.lanes(simd);
        let gradient = kernel.gradient_scale() * fluid.rest_volume();
        let zero = lanes::splat(simd, 0.0);
        for row in (0..along.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let (point, list) = ([x, y, z], lists.group(row));
            let mut sums = Sums { first: [zero; 3], second: Symmetric::splat(simd, 0.0), shape: zero };
            for (entry, stored) in list.iter().zip(&mut pairs[lists.range(row)]) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
                let offset = negative(space.apart(point, [xj, yj, zj]));
                let u = kernel.closeness(dot(offset, offset));
                let c = gradient * (u * u * u);
                lanes::store(stored, 0, c);
                sums.add(c, offset, kernel.shape(u));
            }
            for (entry, c) in self.images.seen(first, row) {
                let [xj, yj, zj, ratio] = lanes::gather_rows(simd, &self.images.position, entry);
                let offset = negative(space.apart(point, [xj, yj, zj]));
                let u = kernel.closeness(dot(offset, offset));
                sums.add(lanes::load_array(simd, c), offset, kernel.shape(u) * ratio);
            }
            let inverse = renormalisation(simd, sums.second, self.divergence.lattice_moment);
            let list = (list, &pairs[lists.range(row)]);
            let diagonal = self.diagonal((simd, space), (first, row), (point, sums.first, inverse), list);
            let density = sums.shape * (kernel.value_scale() * fluid.rest_volume());
            let target = self.target(simd, density, sums.first);
            let [[xx, yy, zz], [yz, zx, xy]] = [inverse.along, inverse.between];
            lanes::store_rows(along, row, [xx, yy, zz, density]);
            lanes::store_rows(between, row, [yz, zx, xy, target]);
            let [zx, zy, zz] = sums.first;
            lanes::store_rows(moment, row, [zx, zy, zz, diagonal]);
        }
    }

    /// The square of the divergence that each particle's own pressure makes, at itself and at its neighbours.
    #[inline(always)]
    fn diagonal<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        (first, row): (usize, usize),
        (point, moment, inverse): (Vec3x8<S>, Vec3x8<S>, Symmetric<S>),
        (list, pairs): (&[[u32; LANES]], &[[f32; LANES]]),
    ) -> f32x8<S> {
        let mut squares = lanes::splat(simd, 0.0);
        for (entry, c) in list.iter().zip(pairs) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
            let push = times(inverse.times(space.apart(point, [xj, yj, zj])), lanes::load_array(simd, c));
            squares += dot(push, push);
        }
        let mut own = negative(inverse.times(moment));
        for (entry, c) in self.images.seen(first, row) {
            let [xj, yj, zj, _] = lanes::gather_rows(simd, &self.images.position, entry);
            let offset = negative(space.apart(point, [xj, yj, zj]));
            let push = times(inverse.times(offset), lanes::load_array(simd, c));
            let (back, others) = self.own_images(first + row, entry, push.map(f32x8::to_array));
            own = plus(own, [0, 1, 2].map(|axis| lanes::load_array(simd, &back[axis])));
            squares += dot(push, push) * lanes::load_array(simd, &others);
        }
        let minimum = MINIMUM_DIAGONAL / (self.params.fluid.spacing * self.params.fluid.spacing);
        (squares + dot(own, own)).max(lanes::splat(simd, minimum))
    }

    /// What particles receive through images of their own, and 0 for those lanes, 1 for the others.
    fn own_images(
        &self,
        row: usize,
        entry: &[u32; LANES],
        [x, y, z]: [[f32; LANES]; 3],
    ) -> ([[f32; LANES]; 3], [f32; LANES]) {
        let (mut back, mut others) = ([[0.0; LANES]; 3], [1.0; LANES]);
        for (lane, image) in entry.iter().enumerate() {
            let image = *image as usize;
            if self.images.source.get(image).is_some_and(|source| *source as usize == row + lane) {
                let own = self.images.back(image, vector(&[x[lane], y[lane], z[lane], 0.0]));
                (0..3).for_each(|axis| back[axis][lane] = own[axis]);
                others[lane] = 0.0;
            }
        }
        (back, others)
    }

    /// The divergence that the error of the density asks for, times the step.
    #[inline(always)]
    fn target<S: Simd>(&self, simd: S, density: f32x8<S>, moment: Vec3x8<S>) -> f32x8<S> {
        let Divergence { surface_moment, surface_lack, .. } = *self.divergence;
        let one = lanes::splat(simd, 1.0);
        let share = dot(moment, moment).sqrt() * (1.0 / surface_moment) - SURFACE_BEGIN;
        let lack = lanes::positive(simd, share * (1.0 / (1.0 - SURFACE_BEGIN))) * surface_lack;
        let error = density + lack - one;
        let size = error.max(-error) - DEAD_ZONE;
        let size = lanes::positive(simd, size).min(lanes::splat(simd, MAXIMUM_ERROR));
        let size = size * (1.0 / CORRECTION_STEPS);
        select(error.simd_gt(lanes::splat(simd, 0.0)), size, -size)
    }
}

/// Inverse of the second moment of a neighbourhood; of one between it and that of a lattice, `moment`, where they are far apart.
#[inline(always)]
fn renormalisation<S: Simd>(simd: S, second: Symmetric<S>, moment: f32) -> Symmetric<S> {
    let one = lanes::splat(simd, 1.0);
    let mut deviation = second.scaled(lanes::splat(simd, 1.0 / moment));
    for axis in 0..3 {
        deviation.along[axis] -= one;
    }
    let norm = deviation.contracted(deviation).sqrt();
    let maximum = lanes::splat(simd, MAXIMUM_DEVIATION);
    let part = select(norm.simd_gt(maximum), maximum / norm, one);
    let mut near = deviation.scaled(part);
    for axis in 0..3 {
        near.along[axis] += one;
    }
    near.inverse(simd).scaled(lanes::splat(simd, 1.0 / moment))
}
