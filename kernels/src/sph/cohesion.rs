//! Surface tension as cohesion between particles \[AAT13, eqs. 1 and 2\].
//!
//! ```text
//! a_i = -A sum_j C(r_ij / H) x_ij / r_ij,   C(s) = (1 - s)^3 s^3 beyond s = 1/2, else 2 (1 - s)^3 s^3 - 1/64
//! ```
//!
//! Particles attract each other from half a support radius on; inside the water the pressure answers, and at a surface what is
//! lacking is the surface tension. Equal and opposite for the two particles of a pair and along the line between them:
//! linear and angular momentum are kept. [`strength`] gives A for a surface tension in N/m.

use crate::{
    columns::{Column::*, Columns, Fluid},
    cpu::Cpu,
    kernel::{Kernel, Need},
    lanes::{self, LANES, Simd, f32x8, prelude::*, select, with_lanes},
    params::{FluidParams, Params},
};

/// `sph::cohesion`.
pub static KERNEL: Kernel = Kernel {
    name: "sph::cohesion",
    needs: &[Need::Fluid, Need::SurfaceTension, Need::Incompressible],
    reads: &[FluidPosition, FluidNeighbors, FluidAcceleration],
    writes: &[FluidAcceleration],
    cpu,
};

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Fluid { position, neighbors, acceleration, .. } = &mut columns.fluid;
    let strength = strength(&params.fluid);
    cpu.for_chunks(&mut acceleration[..], |first, acceleration| {
        let lists = neighbors.chunk(first);
        with_lanes!(cpu, simd => {
            let kernel = params.fluid.smoothing.lanes(simd);
            let radius = lanes::splat(simd, params.fluid.smoothing.support_radius);
            let least = radius * 1.0e-6;
            for row in (0..acceleration.len()).step_by(LANES) {
                let [x, y, z, _] = lanes::load_rows(simd, position, first + row);
                let mut sum = [lanes::splat(simd, 0.0); 3];
                for entry in lists.group(row) {
                    let [xj, yj, zj, _] = lanes::gather_rows(simd, position, entry);
                    let (dx, dy, dz) = (x - xj, y - yj, z - zj);
                    let distance = (dx * dx + dy * dy + dz * dz).sqrt();
                    let u = kernel.closeness(distance * distance);
                    // The particle itself is on its list.
                    let pull = shape(simd, u) / distance.max(least);
                    sum = [sum[0] + pull * dx, sum[1] + pull * dy, sum[2] + pull * dz];
                }
                let [ax, ay, az, aw] = lanes::load_rows(simd, acceleration, row);
                let total = [ax - sum[0] * strength, ay - sum[1] * strength, az - sum[2] * strength, aw];
                lanes::store_rows(acceleration, row, total);
            }
        });
    });
}

/// C of 1 - r / H.
#[inline(always)]
fn shape<S: Simd>(simd: S, u: f32x8<S>) -> f32x8<S> {
    let product = u * (lanes::splat(simd, 1.0) - u);
    let cube = product * product * product;
    let near = cube + cube - lanes::splat(simd, 1.0 / 64.0);
    select(u.simd_gt(lanes::splat(simd, 0.5)), near, cube)
}

/// A \[m/s^2\] of a fluid with a surface tension.
///
/// The surface tension of particles that attract each other is what the pairs lack that a plane cuts \[KB49\]:
/// `sigma = -1/4 sum (r^2 - 3 z^2) / r F(r)` over the pairs that cross a unit of its area. The sum is that of a lattice at
/// rest.
#[must_use]
pub fn strength(fluid: &FluidParams) -> f32 {
    if fluid.surface_tension <= 0.0 {
        return 0.0;
    }
    let (radius, d) = (f64::from(fluid.smoothing.support_radius), f64::from(fluid.spacing));
    let reach = (radius / d).ceil() as i32;
    let mut sum = 0.0;
    for layer in 1..=reach {
        let z = f64::from(layer) * d;
        for (i, k) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |k| (i, k))) {
            let r = (f64::from(i * i + k * k) * d * d + z * z).sqrt();
            sum -= 0.25 * f64::from(layer) / (d * d) * (r * r - 3.0 * z * z) / r * shape_f64(radius, r);
        }
    }
    (f64::from(fluid.surface_tension) / (sum * f64::from(fluid.particle_mass))) as f32
}

/// C at a distance, in f64: the formula itself.
#[must_use]
pub fn shape_f64(support_radius: f64, distance: f64) -> f64 {
    let s = distance / support_radius;
    let cube = ((1.0 - s) * s).powi(3);
    match s {
        _ if s >= 1.0 => 0.0,
        _ if s > 0.5 => cube,
        _ => 2.0 * cube - 1.0 / 64.0,
    }
}
