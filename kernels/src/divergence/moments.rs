//! Moments of the neighbourhoods, once a step, and the divergence that errors of the density ask for.
//!
//! ```text
//! c_ij = J_j V (-dW/dr) / r,   e_ij = x_j - x_i
//! f_i = V sum_j J_j W_ij,   z_i = sum_j c_ij e_ij,   M_i = sum_j c_ij e_ij e_ij^T      images included, and the material of sponges
//! L_i = M_i^-1                                                                       renormalisation [RL96; BL99]
//! D_i = |-L_i z_i + sum_g R_g^T c_ig L_i e_ig|^2 + sum_j |c_ij L_i e_ij|^2           diagonal; g the own images of i
//! e_i = f_i - 1 + k max(0, (|z_i| / z_1 - 1/4) / (3/4))                              error of the density
//! h t_i = clamp(e_i, 1/4) / 5,   B_i = -L_i z_i
//! ```
//!
//! **Why L.** With it the divergence of velocities that are linear in the position is exact, whatever the arrangement of the particles. The
//! force by its transpose keeps energy and both momenta. Without it pairs under a uniform pressure carry shear stress, as in a pile of
//! spheres, and bodies stick in water (docs/history.md). Where M is far from that of a lattice, L is that of a neighbourhood in between.
//!
//! **Surfaces.** z is zero inside, `z_1` in the first layer of a lattice below a flat surface, which lacks k of its neighbours. There the
//! error is zero as well, so that a surface is neither drawn together nor blown up.
//!
//! The sum of `|c L e|^2` is the product of `L^2` and the sum of `c^2 e e^T`: one pass over the neighbours gives all.
//!
//! An error is put right within five steps. If all of a pool would be thrown by that, the target is scaled down (`pressure_solve`). Water
//! that fills a vessel has no free surface, and no target: no pressure could meet it. In pores an error is put right slowly, because the
//! pressure that moves water there is in proportion to the drag.

use glam::Vec3;

use crate::{
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select},
    params::{Divergence, Params},
    periodic::{Space, with_space},
    sph::pressure_solve::Beginning,
    symmetric::Symmetric,
    vector::{Vec3x8, dot, negative, plus, times},
};

use super::{
    image_rows::{ImageRows, Images, NO_BODY, OfParticles},
    rate::{MINIMUM_MATERIAL, SPARSE},
    reflect::{mirrored_renormalisation, vector},
};

declare! {
    needs: [Fluid, Divergence],
    reads: [
        FluidPosition, FluidVelocity, FluidNeighbors, FluidImages, FluidMoment, FluidRenormalisation, FluidRenormalisationBetween,
    ],
    writes: [
        FluidPairs, FluidRenormalisation, FluidRenormalisationBetween, FluidMoment, FluidFactors, FluidPressureRows,
        FluidImageRenormalisation, FluidImageRenormalisationBetween, FluidPressureSolve,
    ],
    oracle: crate::oracle::divergence::moments,
    // The mean target is a small difference of large sums.
    bound: 5e-5,
    twin: [
        pass(NAME, Fluid),
        pass("divergence::diagonal", Fluid),
        pass("divergence::beginning", Fluid),
        pass("divergence::begin_solve", One),
    ],
    constants: {
        /// Largest deviation of the second moment from that of a lattice, as a norm, that is corrected in full.
        const MAXIMUM_DEVIATION: f32 = 0.7;
        /// Smallest diagonal, over the inverse of the squared spacing.
        const MINIMUM_DIAGONAL: f32 = 1.0e-3;
        /// First moment over that at a flat surface from which on neighbours are missing for good.
        const SURFACE_BEGIN: f32 = 0.25;
        /// The same from which on water is taken to have a free surface there. In a full vessel no particle has one.
        const SURFACE_OPEN: f32 = 0.5;
        /// Error of the density that is none.
        const DEAD_ZONE: f32 = 1.0e-3;
        /// Largest error that is put right.
        const MAXIMUM_ERROR: f32 = 0.25;
        /// Steps in which it is.
        const CORRECTION_STEPS: f32 = 5.0;
        /// Error of the density that is none in a sponge.
        const DEAD_ZONE_IN_PORES: f32 = 5.0e-3;
        /// Time in which a larger one is put right there \[s\].
        const CORRECTION_TIME_IN_PORES: f32 = 0.02;
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
        factors,
        pressure_rows,
        image_renormalisation,
        image_renormalisation_between,
        pressure_solve,
        ..
    } = &mut columns.fluid;
    for column in [&mut *renormalisation, renormalisation_between, moment, factors, pressure_rows] {
        column.resize(position.len(), [0.0; 4]);
    }
    let mirrored = mirrored_rows(images, [image_renormalisation, image_renormalisation_between]);
    let task = Task { params, divergence, position, velocity, images };
    let rows = (
        ((&mut renormalisation[..], &mut renormalisation_between[..]), &mut moment[..]),
        (&mut factors[..], &mut pressure_rows[..]),
        pairs.match_lists(neighbors),
        (pressure_solve.beginnings(position.len()), mirrored),
    );
    cpu.for_chunks(rows, |first, rows| {
        let (((along, between), moment), (factors, pressure), pairs, (beginning, mirrored)) = rows;
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space => task.chunk(
            (simd, space), first, lists, &mut pairs.0[0], [along, between, moment, factors, pressure]));
        // Padding rows must not move and must not push.
        let used = count.saturating_sub(first).min(along.len());
        [&mut *along, between, moment, factors].into_iter().for_each(|rows| rows[used..].fill([0.0; 4]));
        pressure[used..].fill([0.0, 0.0, 1.0, 0.0]);
        let open = SURFACE_OPEN * divergence.surface_moment;
        let places = moment.iter().zip(&*along).map(|(moment, along)| {
            let is_in_pores = moment[lane::fluid::moment::MATERIAL] > MINIMUM_MATERIAL;
            let is_sparse = along[lane::fluid::renormalisation::DENSITY] < SPARSE;
            (is_in_pores, is_sparse || vector(moment).length_squared() > open * open)
        });
        let targets = factors.iter().map(|row| row[lane::fluid::factors::TARGET]);
        beginning.0[0] = Beginning::of(&velocity[first..first + used], targets, places);
        mirror(images, first, [along, between], mirrored);
    });
    pressure_solve.begin_divergence(count, params);
}

/// A row for every image.
fn mirrored_rows<'a>(images: &'a Images, [along, between]: [&'a mut ImageRows; 2]) -> Mirrored<'a> {
    let count = images.count();
    for rows in [&mut along.0, &mut between.0] {
        rows.resize(images.position.len(), [0.0; 4]);
        rows[count..].fill([0.0; 4]);
    }
    let [along, between] = [&mut along.0[..count], &mut between.0[..count]];
    (OfParticles::new(along, &images.first), OfParticles::new(between, &images.first))
}

/// Rows along and between the axes.
type Mirrored<'a> = (OfParticles<'a, [f32; 4]>, OfParticles<'a, [f32; 4]>);

/// The renormalisation of images in walls alone, from that of particles, the first of which has the row `first`.
fn mirror(images: &Images, first: usize, renormalisation: [&[[f32; 4]]; 2], (along, between): Mirrored<'_>) {
    let ((start, along), (_, between)) = (along.all(), between.all());
    for (index, (along, between)) in along.iter_mut().zip(between).enumerate() {
        let image = start + index;
        let source = images.source[image] as usize - first;
        let rows = renormalisation.map(|rows| rows[source]);
        let is_in_body = images.body[image] != NO_BODY;
        let mirrored = mirrored_renormalisation(images.signs(image), rows);
        (*along, *between) = if is_in_body { ([0.0; 4], [0.0; 4]) } else { mirrored };
    }
}

/// Sums over neighbours and images.
#[derive(Clone, Copy)]
struct Sums<S: Simd> {
    first: Vec3x8<S>,
    second: Symmetric<S>,
    /// Of `c^2 e e^T`.
    squares: Symmetric<S>,
    shape: f32x8<S>,
}

impl<S: Simd> Sums<S> {
    #[inline(always)]
    fn add(&mut self, c: f32x8<S>, offset: Vec3x8<S>, shape: f32x8<S>) {
        let push = times(offset, c);
        self.first = plus(self.first, push);
        self.second.add_square(push, offset);
        self.squares.add_square(push, push);
        self.shape += shape;
    }
}

struct Task<'a> {
    params: &'a Params,
    divergence: &'a Divergence,
    position: &'a [[f32; 4]],
    velocity: &'a [[f32; 4]],
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
        [along, between, moment, factors, pressure]: [&mut [[f32; 4]]; 5],
    ) {
        let fluid = &self.params.fluid;
        let kernel = fluid.smoothing.lanes(simd);
        let gradient = kernel.gradient_scale() * fluid.rest_volume();
        let (zero, none) = (lanes::splat(simd, 0.0), Symmetric::splat(simd, 0.0));
        for row in (0..along.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let (point, list) = ([x, y, z], lists.group(row));
            let mut sums = Sums { first: [zero; 3], second: none, squares: none, shape: zero };
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
            // The moments begin with those of the material of sponges.
            let [zx, zy, zz, material] = lanes::load_rows(simd, moment, row);
            let [sxx, syy, szz, _] = lanes::load_rows(simd, along, row);
            let [syz, szx, sxy, _] = lanes::load_rows(simd, between, row);
            sums.first = plus(sums.first, [zx, zy, zz]);
            sums.second.along = plus(sums.second.along, [sxx, syy, szz]);
            sums.second.between = plus(sums.second.between, [syz, szx, sxy]);
            let density = sums.shape * (kernel.value_scale() * fluid.rest_volume()) + material;
            let inverse = renormalisation(simd, sums.second, self.divergence.lattice_moment);
            let target = self.target(simd, (density, material), sums.first);
            let [bx, by, bz] = negative(inverse.times(sums.first));
            let diagonal = self.diagonal((simd, space), first + row, ([bx, by, bz], inverse), sums.squares);
            let ([xx, yy, zz], [yz, zx, xy]) = (inverse.along, inverse.between);
            lanes::store_rows(along, row, [xx, yy, zz, density]);
            lanes::store_rows(between, row, [yz, zx, xy, zero]);
            lanes::store_rows(moment, row, [sums.first[0], sums.first[1], sums.first[2], material]);
            lanes::store_rows(factors, row, [bx, by, bz, target]);
            let [_, _, _, before] = lanes::load_rows(simd, self.velocity, first + row);
            let before = select(density.simd_ge(lanes::splat(simd, SPARSE)), before, zero);
            let square = self.params.step * self.params.step;
            lanes::store_rows(pressure, row, [before, zero, diagonal * square, zero]);
        }
    }

    /// The square of the divergence that each particle's own pressure makes, at itself and at its neighbours.
    #[inline(always)]
    fn diagonal<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        row: usize,
        (push, inverse): (Vec3x8<S>, Symmetric<S>),
        squares: Symmetric<S>,
    ) -> f32x8<S> {
        let fluid = &self.params.fluid;
        let kernel = fluid.smoothing.lanes(simd);
        let gradient = kernel.gradient_scale() * fluid.rest_volume();
        let mut others = inverse.squared().contracted(squares);
        let mut push = push;
        let [x, y, z, _] = lanes::load_rows(simd, self.position, row);
        let own: [_; LANES] = std::array::from_fn(|lane| self.images.of(row + lane));
        let most = own.iter().map(ExactSizeIterator::len).max().unwrap_or(0);
        for place in 0..most {
            // Lanes with fewer images take the padding row, which is far away.
            let entry =
                own.each_ref().map(|own| own.clone().nth(place).unwrap_or(self.images.count()) as u32);
            let [xg, yg, zg, ratio] = lanes::gather_rows(simd, &self.images.position, &entry);
            let offset = negative(space.apart([x, y, z], [xg, yg, zg]));
            let u = kernel.closeness(dot(offset, offset));
            let received = times(inverse.times(offset), gradient * (u * u * u) * ratio);
            push = plus(push, self.back((simd, &entry), received));
            others -= dot(received, received);
        }
        let others = lanes::positive(simd, others);
        let minimum = MINIMUM_DIAGONAL / (self.params.fluid.spacing * self.params.fluid.spacing);
        (others + dot(push, push)).max(lanes::splat(simd, minimum))
    }

    /// The transposed maps of eight images back to their particles.
    #[inline(always)]
    fn back<S: Simd>(&self, (simd, entry): (S, &[u32; LANES]), received: Vec3x8<S>) -> Vec3x8<S> {
        let mut back = [[0.0; LANES]; 3];
        for (lane, image) in
            entry.iter().enumerate().filter(|(_, image)| (**image as usize) < self.images.count())
        {
            let received = Vec3::new(received[0][lane], received[1][lane], received[2][lane]);
            let own = self.images.back(*image as usize, received);
            (0..3).for_each(|axis| back[axis][lane] = own[axis]);
        }
        back.each_ref().map(|lanes| lanes::load_array(simd, lanes))
    }

    /// The divergence that the error of the density asks for, times the step.
    #[inline(always)]
    fn target<S: Simd>(
        &self,
        simd: S,
        (density, material): (f32x8<S>, f32x8<S>),
        moment: Vec3x8<S>,
    ) -> f32x8<S> {
        let Divergence { surface_moment, surface_lack, .. } = *self.divergence;
        let splat = |value| lanes::splat(simd, value);
        let at_surface = dot(moment, moment).sqrt() * (1.0 / surface_moment) - SURFACE_BEGIN;
        let lack = lanes::positive(simd, at_surface * (1.0 / (1.0 - SURFACE_BEGIN))) * surface_lack;
        let error = density + lack - splat(1.0);
        let is_in_pores = material.simd_gt(splat(MINIMUM_MATERIAL));
        let dead_zone = select(is_in_pores, splat(DEAD_ZONE_IN_PORES), splat(DEAD_ZONE));
        let size = lanes::positive(simd, error.max(-error) - dead_zone).min(splat(MAXIMUM_ERROR));
        let slow = (self.params.step / CORRECTION_TIME_IN_PORES).min(1.0 / CORRECTION_STEPS);
        let size = size * select(is_in_pores, splat(slow), splat(1.0 / CORRECTION_STEPS));
        select(error.simd_gt(splat(0.0)), size, -size)
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
