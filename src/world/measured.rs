//! Values that are computed for reading the state, not for a step.

use sorb_kernels::{
    asleep::Asleep,
    columns::{Columns, lane},
    couple, divergence, grid,
    kernel::Kernel,
    params::Params,
    pbd, sph,
};

use super::World;
use crate::schedule::{PlannedPhase, Verdict};

/// The moments of a solve for the divergence, in a scene with porous sponges and in others.
static MOMENTS_WITH_SPONGES: &[&Kernel] = &[
    &couple::controls::KERNEL,
    &couple::saturation::KERNEL,
    &couple::pores::KERNEL,
    &couple::interior::KERNEL,
    &pbd::gravity::KERNEL,
    &divergence::images::KERNEL,
    &couple::solid_expect::KERNEL,
    &couple::solid_moments::KERNEL,
    &divergence::moments::KERNEL,
];
static MOMENTS: &[&Kernel] = &[&divergence::images::KERNEL, &divergence::moments::KERNEL];

/// The boundary volume fraction, likewise.
static BOUNDARY_WITH_SPONGES: &[&Kernel] = &[
    &sph::predict::KERNEL,
    &sph::boundary::KERNEL,
    &couple::controls::KERNEL,
    &pbd::gravity::KERNEL,
    &couple::solid_pressure::KERNEL,
    &couple::solid_share::KERNEL,
];
static BOUNDARY: &[&Kernel] = &[&sph::predict::KERNEL, &sph::boundary::KERNEL];

impl World {
    /// Runs the phases that measures depend on, so that they are valid at time zero as well.
    pub(super) fn compute_measured(&mut self) {
        let phases = [
            &grid::sort_fluid::KERNEL,
            &grid::fluid_neighbors::KERNEL,
            &sph::density::KERNEL,
            &couple::controls::KERNEL,
            &couple::saturation::KERNEL,
            &couple::pores::KERNEL,
            &couple::interior::KERNEL,
        ];
        for kernel in phases {
            if self.runs(kernel) {
                let Self { cpu, params, stores, .. } = self;
                cpu.enter(|| (kernel.cpu)(cpu, params, &mut stores.host));
            }
        }
    }

    /// Whether a kernel is part of a step.
    fn runs(&self, kernel: &Kernel) -> bool {
        let runs = |line: &PlannedPhase| line.name == kernel.name && line.verdict == Verdict::Runs;
        self.plan().lines().iter().any(runs)
    }

    /// Columns with the density and the boundary volume fraction at the present positions: a pressure solve needs neither
    /// there.
    pub(crate) fn summed_density(&self) -> Columns {
        let mut columns = self.stores.view().clone();
        // Before the first step no compression is permitted.
        columns.fluid.acceleration.resize(columns.fluid.position.len(), [0.0; 4]);
        let params = Params { step: 0.0, asleep: Asleep::default(), ..self.params.clone() };
        let phases = [&grid::sort_fluid::KERNEL, &grid::fluid_neighbors::KERNEL, &sph::density::KERNEL];
        let around = match params.fluid.divergence() {
            Some(_) if self.runs(&couple::solid_moments::KERNEL) => MOMENTS_WITH_SPONGES,
            Some(_) => MOMENTS,
            None if self.runs(&couple::solid_share::KERNEL) => BOUNDARY_WITH_SPONGES,
            None => BOUNDARY,
        };
        let phases = phases.iter().chain(around);
        self.cpu.enter(|| phases.for_each(|kernel| (kernel.cpu)(&self.cpu, &params, &mut columns)));
        columns
    }

    /// Density of every particle over that at rest, with walls, bodies and the material of sponges where pressure is solved for.
    pub(crate) fn filled(&self) -> Vec<f64> {
        let fluid = &self.params.fluid;
        let ratio = |density: &f32| f64::from(*density) / f64::from(fluid.rest_density);
        let count = self.particle_positions().len();
        if count == 0 {
            return Vec::new();
        }
        if fluid.incompressible.is_none() {
            return self.columns().fluid.density.iter().take(count).map(ratio).collect();
        }
        let Columns { fluid: summed, rows, .. } = self.summed_density();
        let filled = |row: usize| match fluid.divergence() {
            Some(_) => f64::from(summed.renormalisation[row][lane::fluid::renormalisation::DENSITY]),
            None => {
                ratio(&summed.density[row]) + f64::from(summed.boundary[row][lane::fluid::boundary::SHARE])
            }
        };
        (0..rows.fluid).map(filled).collect()
    }
}
