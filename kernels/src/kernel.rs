//! A kernel: what it reads and writes, what it needs, and how the CPU computes it.

use crate::{
    columns::{Column, Columns},
    couple,
    cpu::Cpu,
    grid,
    params::Params,
    pbd, sph,
};

pub use crate::need::Need;

/// One phase of a step: a declaration and a body. The same name is used for its path, its WGSL twin, its bench
/// and its line in a plan.
#[derive(Debug)]
pub struct Kernel {
    /// `family::name`.
    pub name: &'static str,
    /// What the scene must contain; all of these.
    pub needs: &'static [Need],
    /// Columns whose content before the kernel matters.
    pub reads: &'static [Column],
    /// Columns that the kernel changes.
    pub writes: &'static [Column],
    /// The body for the CPU.
    pub cpu: fn(&Cpu, &Params, &mut Columns),
}

/// Every kernel, by family.
pub static KERNELS: &[&Kernel] = &[
    &grid::sort_fluid::KERNEL,
    &grid::fluid_neighbors::KERNEL,
    &sph::density::KERNEL,
    &sph::pressure::KERNEL,
    &sph::forces::KERNEL,
    &sph::surface_tension::KERNEL,
    &sph::deficit::KERNEL,
    &sph::cohesion::KERNEL,
    &sph::repulsion::KERNEL,
    &sph::boundary_pressure::KERNEL,
    &sph::wall_friction::KERNEL,
    &sph::kick::KERNEL,
    &sph::viscosity_begin::KERNEL,
    &sph::viscosity_product::KERNEL,
    &sph::viscosity_update::KERNEL,
    &sph::viscosity_reaction::KERNEL,
    &sph::viscosity_kick::KERNEL,
    &sph::predict::KERNEL,
    &sph::boundary::KERNEL,
    &sph::factors::KERNEL,
    &sph::pressure_update::KERNEL,
    &sph::pressure_acceleration::KERNEL,
    &sph::pressure_residual::KERNEL,
    &sph::pressure_kick::KERNEL,
    &sph::position_correction::KERNEL,
    &sph::boundary_reaction::KERNEL,
    &sph::sweep::KERNEL,
    &sph::advect::KERNEL,
    &pbd::pairs::KERNEL,
    &pbd::gravity::KERNEL,
    &pbd::predict::KERNEL,
    &pbd::guess::KERNEL,
    &pbd::touch::KERNEL,
    &pbd::strain::KERNEL,
    &pbd::xpbd_neo_hookean::KERNEL,
    &pbd::vbd::KERNEL,
    &pbd::contact::KERNEL,
    &pbd::reaction::KERNEL,
    &pbd::momentum::KERNEL,
    &pbd::velocity::KERNEL,
    &couple::controls::KERNEL,
    &couple::saturation::KERNEL,
    &couple::wetting::KERNEL,
    &couple::pores::KERNEL,
    &couple::interior::KERNEL,
    &couple::suction::KERNEL,
    &couple::zero_distance::KERNEL,
    &couple::control_velocity::KERNEL,
    &couple::drag::KERNEL,
    &couple::velocity_filter::KERNEL,
    &couple::exchange::KERNEL,
    &couple::solid_pressure::KERNEL,
    &couple::solid_share::KERNEL,
    &couple::solid_yield::KERNEL,
    &couple::solid_reaction::KERNEL,
    &couple::node_velocity::KERNEL,
    &couple::drag_impulse::KERNEL,
    &couple::drag_target::KERNEL,
    &couple::drag_reaction::KERNEL,
    &couple::drag_settled::KERNEL,
    &couple::drag_kick::KERNEL,
];

/// Whether the solves that a kernel writes to have converged.
#[must_use]
pub fn has_converged(kernel: &Kernel, columns: &Columns) -> bool {
    kernel.writes.iter().all(|column| match column {
        Column::FluidPressureSolve => columns.fluid.pressure_solve.is_converged(),
        Column::FluidViscositySolve => columns.fluid.viscosity_solve.is_converged(),
        _ => true,
    })
}

/// The kernel of that name.
#[must_use]
pub fn kernel(name: &str) -> Option<&'static Kernel> {
    KERNELS.iter().copied().find(|kernel| kernel.name == name)
}
