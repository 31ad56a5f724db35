//! Content of a scene that a phase or a column is for.

use crate::params::Solver;

/// Something that a scene must contain for a phase to have work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Fluid particles.
    Fluid,
    /// A sponge.
    Sponge,
    /// A sponge with this solver.
    Solver(Solver),
    /// A sponge whose solver moves nodes first and handles contact afterwards.
    Projection,
    /// Walls of a container, or bodies.
    Obstacles,
    /// Rigid bodies.
    Bodies,
    /// Fluid with surface tension from the colour field.
    SurfaceTension,
    /// Fluid with surface tension from a surface energy.
    Cohesion,
    /// No-slip walls or bodies.
    NoSlip,
    /// Fluid whose films and drops stick to what they lie on.
    Retention,
    /// Explicit viscosity, as part of the forces.
    ExplicitViscosity,
    /// Viscosity by the rate of strain.
    StrainRate,
    /// Implicit viscosity, as a solve for the velocities at the end of the step.
    ImplicitViscosity,
    /// No sponges: no material takes a part of the pressure.
    NoSponges,
    /// Pressure by an equation of state.
    EquationOfState,
    /// A pressure solve, or position based fluids.
    Incompressible,
    /// A pressure solve for the density, or position based fluids.
    Density,
    /// A pressure solve for the divergence of the velocities.
    Divergence,
    /// Sponges as porous media: their material displaces fluid.
    Porous,
    /// Particles in sponges exchange momentum with the corners of their tets.
    Barycentric,
    /// Particles in sponges exchange momentum with all nodes within the suction radius.
    Smoothed,
    /// A sponge with properties that depend on wetness.
    Wetting,
    /// A sponge that can touch another or itself.
    Touch,
}
