//! What a phase or a column is for.

use crate::params::Solver;

/// Something that a scene must contain for a phase to have work.
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
