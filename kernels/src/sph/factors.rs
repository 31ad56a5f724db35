//! Coefficients of the pressure solve at the predicted positions, in one pass over the neighbours.
//!
//! ```text
//! c_ij = V (-dW/dr) / r                            grad W_ij = -c_ij x_ij / V
//! r_i = sum_j V W_ij + lambda_i - 1 + s_i          compression, if the pressure stays as it is
//! B_i = sum_j c_ij x_ij - grad lambda_i            acceleration by the particle's own pressure
//! M_i = h^2 (|B_i|^2 + sum_j |c_ij x_ij|^2) + b e sum_j c_ij    diagonal of the system [BK17, eq. 8]
//! ```
//!
//! A pressure that alternates from particle to particle exerts no force in a lattice. Without a remedy the solve would
//! answer an alternating compression by amplifying such a pressure. With
//!
//! ```text
//! w_i = e sum_j c_ij (q_j - q_i)
//! ```
//!
//! of `sph::forces`, and the same of the pressure change, a compression of `-w_i` is permitted. This is e times the compact
//! Laplacian of the pressure, beside h^2 times the wide one \[RC83\]. The coefficient e does not depend on the step:
//! otherwise the water would move whenever the step changes. In steps that are short compared with `sqrt(e)` the permitted
//! compression s follows w with a delay, by a share b per step (`sph::predict`).
//!
//! A density error is corrected at a limited speed: particles that begin at one place would otherwise fly apart.

use crate::{
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd},
    params::{Incompressible, Params},
    periodic::{Space, with_space},
    vector::dot,
};

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPosition, FluidPredicted, FluidNeighbors, FluidBoundary, FluidAcceleration],
    writes: [FluidFactors, FluidPairs, FluidPressureRows, FluidSolidYield, FluidPressureSolve],
    oracle: crate::oracle::incompressible::factors,
    bound: 4e-6,
    twin: [pass(NAME, Fluid), pass("sph::solve_begin", One)],
    constants: {
        /// Diagonal of a lattice over the least that a particle may have: a lone one is not moved by its own pressure.
        const LATTICE_DIAGONAL_RATIO: f32 = 3.0;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.fluid;
    let Fluid {
        position,
        predicted,
        neighbors,
        boundary,
        acceleration,
        factors,
        pairs,
        pressure_rows,
        solid_yield,
        pressure_solve,
        ..
    } = &mut columns.fluid;
    let Some(solve) = &params.fluid.incompressible else { return };
    // With sponges, every iteration of the solve computes the compliance of their material.
    solid_yield.clear();
    factors.resize(predicted.len(), [0.0; 4]);
    pressure_rows.resize(predicted.len(), [0.0; 4]);
    let displacements = pressure_solve.displacements(predicted.len());
    let rows = (&mut factors[..], &mut pressure_rows[..], pairs.match_lists(neighbors), displacements);
    let task = Task { params, solve, position, predicted, boundary, acceleration };
    cpu.for_chunks(rows, |first, (factors, pressure, pairs, displacement)| {
        let lists = neighbors.chunk(first);
        with_space!(cpu, params, simd, space =>
            task.chunk((simd, space), first, lists, &mut pairs.0[0], factors, pressure));
        // Padding rows must not move and must not push.
        let used = count.saturating_sub(first).min(factors.len());
        factors[used..].fill([0.0; 4]);
        pressure[used..].fill([0.0, 0.0, 1.0, 0.0]);
        displacement.0[0] = squares(&position[first..first + used], &predicted[first..]);
    });
    pressure_solve.begin(count, params.fluid.spacing, solve);
}

/// Sum of the squared displacements in the step.
fn squares(position: &[[f32; 4]], predicted: &[[f32; 4]]) -> f32 {
    let mut sum = 0.0;
    for (x, end) in position.iter().zip(predicted) {
        let [dx, dy, dz] = [end[0] - x[0], end[1] - x[1], end[2] - x[2]];
        sum += dx * dx + dy * dy + dz * dz;
    }
    sum
}

struct Task<'a> {
    params: &'a Params,
    solve: &'a Incompressible,
    position: &'a [[f32; 4]],
    predicted: &'a [[f32; 4]],
    boundary: &'a [[f32; 4]],
    acceleration: &'a [[f32; 4]],
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        first: usize,
        lists: &ChunkLists,
        pairs: &mut [[f32; LANES]],
        factors: &mut [[f32; 4]],
        pressure: &mut [[f32; 4]],
    ) {
        let (fluid, step) = (&self.params.fluid, self.params.step);
        let kernel = fluid.smoothing.lanes(simd);
        let volume = fluid.particle_mass / fluid.rest_density;
        let (gradient, value) = (kernel.gradient_scale() * volume, kernel.value_scale() * volume);
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let minimum = lanes::splat(simd, 1.0 / LATTICE_DIAGONAL_RATIO * self.solve.lattice_diagonal);
        let prompt = fluid.prompt_roughness(step);
        let maximum = lanes::splat(simd, self.solve.correction_speed * step / fluid.spacing);
        for row in (0..factors.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.predicted, first + row);
            let mut own = [zero; 3];
            let (mut others, mut shape_sum, mut pair_sum) = (zero, zero, zero);
            for (entry, stored) in lists.group(row).iter().zip(&mut pairs[lists.range(row)]) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.predicted, entry);
                let [dx, dy, dz] = space.apart([x, y, z], [xj, yj, zj]);
                let square = dx * dx + dy * dy + dz * dz;
                let u = kernel.closeness(square);
                let c = gradient * (u * u * u);
                lanes::store(stored, 0, c);
                own = [own[0] + c * dx, own[1] + c * dy, own[2] + c * dz];
                others += c * c * square;
                pair_sum += c;
                shape_sum += kernel.shape(u);
            }
            let [gx, gy, gz, share] = lanes::load_rows(simd, self.boundary, first + row);
            let own = [own[0] - gx, own[1] - gy, own[2] - gz];
            // The lists contain the particle itself, which is no pair.
            let rough = (pair_sum - gradient) * prompt;
            let diagonal = (dot(own, own) + others).max(minimum) * (step * step) + rough;
            let [_, _, _, allowed] = lanes::load_rows(simd, self.acceleration, first + row);
            let compression = (shape_sum * value + share - one + allowed).min(maximum);
            lanes::store_rows(factors, row, [own[0], own[1], own[2], compression]);
            let [_, _, _, before] = lanes::load_rows(simd, self.position, first + row);
            lanes::store_rows(pressure, row, [before * fluid.rest_density, zero, diagonal, compression]);
        }
    }
}
