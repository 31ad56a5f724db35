//! What a scene must contain for a phase to have work, and why a phase is skipped.

use crate::params::Solver;

/// Something that a scene must contain for a kernel to have work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Fluid particles.
    Fluid,
    /// A sponge.
    Sponge,
    /// A sponge that this solver solves.
    Solver(Solver),
    /// A sponge whose solver moves nodes first and contact afterwards.
    Projection,
    /// Walls of a container, or bodies.
    Obstacles,
    /// Rigid bodies.
    Bodies,
    /// Fluid with surface tension from the colour field.
    SurfaceTension,
    /// Fluid with surface tension from an energy of the surface.
    Cohesion,
    /// Walls or bodies that the fluid does not slide along.
    NoSlip,
    /// Viscosity as part of the forces.
    ExplicitViscosity,
    /// Viscosity as a solve for the velocities at the end of the step.
    ImplicitViscosity,
    /// Pressure by an equation of state.
    EquationOfState,
    /// Pressure by a solve that keeps the density.
    Incompressible,
    /// Sponges as porous media: their material displaces fluid.
    Porous,
    /// A sponge with properties that depend on how wet it is.
    Wetting,
    /// A sponge that can touch another or itself.
    Touch,
}

impl Need {
    /// Why a phase is skipped when the need is not met.
    #[must_use]
    pub fn missing(self) -> &'static str {
        match self {
            Self::Fluid => "no fluid",
            Self::Sponge => "no sponge",
            Self::Solver(Solver::Sbd) => "no sponge with solver sbd",
            Self::Solver(Solver::Vbd) => "no sponge with solver vbd",
            Self::Solver(Solver::XpbdNeoHookean) => "no sponge with solver xpbd_neo_hookean",
            Self::Projection => "no sponge with solver sbd or xpbd_neo_hookean",
            Self::Obstacles => "no walls and no bodies",
            Self::Bodies => "no bodies",
            Self::SurfaceTension => "no surface tension from the colour field",
            Self::Cohesion => "no surface tension by cohesion",
            Self::NoSlip => "fluid slides along everything",
            Self::ExplicitViscosity => "viscosity is implicit",
            Self::ImplicitViscosity => "viscosity is explicit",
            Self::EquationOfState => "pressure is solved for",
            Self::Incompressible => "pressure by an equation of state",
            Self::Porous => "coupling of the paper",
            Self::Wetting => "no sponge depends on how wet it is",
            Self::Touch => "no sponge can touch another or itself",
        }
    }
}
