//! Before the first iteration of the implicit viscosity: the residual of the velocities after the kick, and the friction of
//! walls and bodies.
//!
//! ```text
//! (1 + h D) v = v*,   D_i(v) = D_i(pairs) + F_i v_i - g_i
//! F_i = sum_s f(y) (1 - n n^T),   g_i = sum_s f(y) (1 - n n^T) v_s
//! r_i = p_i = -h D_i(v*),   y_i = 0
//! ```
//!
//! over the no-slip surfaces `s`, with `f` from `sph::wall_friction`, but without its limit by the step, and the pairs of
//! `viscosity`. What `sph::viscosity_strain` left in the place of the product is part of D. `viscosity_solve` has the iteration.

use crate::{
    body::{Body, Placed},
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8},
    params::Params,
    periodic::{Space, with_space},
    vector::{Vec3x8, minus, plus, times},
};

use super::{
    friction::{along, friction_rate},
    obstacles::near,
    viscosity::Pairs,
};

declare! {
    needs: [Fluid, ImplicitViscosity],
    reads: [FluidPosition, FluidVelocity, FluidNeighbors, FluidViscosityProduct, BodyStates],
    writes: [
        FluidFriction, FluidFrictionBetween, FluidViscosityResidual, FluidViscosityDirection,
        FluidViscosityChange, FluidViscositySolve,
    ],
    oracle: crate::oracle::viscosity::begin,
    bound: 4e-6,
    twin: [pass("sph::viscosity_friction", Fluid), pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid {
        position,
        velocity,
        neighbors,
        friction,
        friction_between,
        viscosity_residual: residual,
        viscosity_direction: direction,
        viscosity_product: strained,
        viscosity_change: change,
        viscosity_solve: solve,
        ..
    } = &mut columns.fluid;
    for rows in [&mut *friction, &mut *friction_between, &mut *residual, &mut *direction, &mut *change] {
        rows.resize(position.len(), [0.0; 4]);
    }
    solve.begin();
    let task = Task { params, bodies: &columns.bodies.states.0, position, velocity, strained };
    let rows = (&mut friction[..], &mut friction_between[..], &mut residual[..], &mut direction[..]);
    cpu.for_chunks(rows, |first, (friction, between, residual, direction)| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            task.chunk((simd, space), first, lists, friction, between, residual, direction));
    });
    // Padding rows fill up the lists: they must stay zero.
    residual[count..].fill([0.0; 4]);
    direction[count..].fill([0.0; 4]);
    change.fill([0.0; 4]);
}

struct Task<'a> {
    params: &'a Params,
    bodies: &'a [Body],
    position: &'a [[f32; 4]],
    velocity: &'a [[f32; 4]],
    /// Deceleration by the rate of strain, if there is viscosity of that form.
    strained: &'a [[f32; 4]],
}

/// The friction at eight particles.
struct Friction<S: Simd> {
    /// F: xx, yy, zz.
    axes: Vec3x8<S>,
    /// F: yz, zx, xy.
    between: Vec3x8<S>,
    /// `F v - g`.
    slowed: Vec3x8<S>,
}

impl Task<'_> {
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "four columns are written at once")]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        first: usize,
        lists: &ChunkLists,
        friction: &mut [[f32; 4]],
        between: &mut [[f32; 4]],
        residual: &mut [[f32; 4]],
        direction: &mut [[f32; 4]],
    ) {
        let pairs = Pairs::new((simd, space), self.params, self.position);
        let radius = self.params.fluid.smoothing.support_radius;
        let near = near(self.bodies, &self.position[first..first + residual.len()], radius);
        let is_strained = self.params.fluid.strain_viscosity > 0.0;
        let zero = lanes::splat(simd, 0.0);
        let back = lanes::splat(simd, -self.params.step);
        for row in (0..residual.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let [vx, vy, vz, _] = lanes::load_rows(simd, self.velocity, first + row);
            let mut own = self.walls(simd, [x, y, z], [vx, vy, vz]);
            for body in near.iter().map(|body| &self.bodies[*body]).filter(|body| body.no_slip) {
                self.add(simd, body, [x, y, z], [vx, vy, vz], &mut own);
            }
            let sum = plus(pairs.of(self.velocity, first + row, lists.group(row)), own.slowed);
            let sum = if is_strained {
                let [sx, sy, sz, _] = lanes::load_rows(simd, self.strained, first + row);
                plus(sum, [sx, sy, sz])
            } else {
                sum
            };
            let [rx, ry, rz] = times(sum, back);
            lanes::store_rows(residual, row, [rx, ry, rz, zero]);
            lanes::store_rows(direction, row, [rx, ry, rz, zero]);
            let [xx, yy, zz] = own.axes;
            lanes::store_rows(friction, row, [xx, yy, zz, zero]);
            let [yz, zx, xy] = own.between;
            lanes::store_rows(between, row, [yz, zx, xy, zero]);
        }
    }

    /// The friction of the walls of the container.
    #[inline(always)]
    fn walls<S: Simd>(&self, simd: S, point: Vec3x8<S>, velocity: Vec3x8<S>) -> Friction<S> {
        let zero = lanes::splat(simd, 0.0);
        let mut own = Friction { axes: [zero; 3], between: [zero; 3], slowed: [zero; 3] };
        let Some((low, high)) = self.params.walls.filter(|_| self.params.no_slip) else { return own };
        for axis in 0..3 {
            let below = self.rate(simd, point[axis] - low[axis]);
            let above = self.rate(simd, lanes::splat(simd, high[axis]) - point[axis]);
            for other in 0..3 {
                if other != axis {
                    own.axes[other] += below + above;
                }
            }
        }
        let ([fx, fy, fz], [vx, vy, vz]) = (own.axes, velocity);
        own.slowed = [fx * vx, fy * vy, fz * vz];
        own
    }

    /// Adds the friction of a body.
    #[inline(always)]
    fn add<S: Simd>(
        &self,
        simd: S,
        body: &Body,
        point: Vec3x8<S>,
        velocity: Vec3x8<S>,
        own: &mut Friction<S>,
    ) {
        let placed = Placed::new(simd, body);
        let (distance, normal) = placed.distance(point);
        let rate = self.rate(simd, distance);
        let [x, y, z] = normal;
        let one = lanes::splat(simd, 1.0);
        own.axes = plus(own.axes, times([one - x * x, one - y * y, one - z * z], rate));
        own.between = minus(own.between, times([y * z, z * x, x * y], rate));
        let slide = along(minus(velocity, placed.velocity(point)), normal);
        own.slowed = plus(own.slowed, times(slide, rate));
    }

    /// f(y) \[1/s\].
    #[inline(always)]
    fn rate<S: Simd>(&self, simd: S, distance: f32x8<S>) -> f32x8<S> {
        lanes::positive(simd, friction_rate(simd, &self.params.fluid, distance))
    }
}
