//! Parameters of a step: numbers only, in SI units.

mod sponge;

use glam::Vec3;

use crate::{
    asleep::Asleep,
    column::FAR,
    grid::cells::Domain,
    layout::{constants, enumeration},
    periodic::Periodic,
    smoothing::Wendland,
};

pub use sponge::{Solver, SpongeParams, WettingParams};

/// Distance from the origin of walls that are not there \[m\]: finite, as shaders ask for, and out of reach.
pub const NO_WALL: f32 = FAR;

/// Everything that kernels need to know beside the columns.
#[derive(Clone, Debug)]
pub struct Params {
    /// Length of the step \[s\].
    pub step: f32,
    /// Acceleration of free fall \[m/s^2\].
    pub gravity: Vec3,
    /// Where points may be, for the search.
    pub domain: Domain,
    /// Walls of the container: corners of the box that everything stays in, at [`NO_WALL`] along axes that have none.
    pub walls: Option<(Vec3, Vec3)>,
    /// Axes on which space repeats.
    pub periodic: Option<Periodic>,
    /// Whether the fluid at those walls rests (no-slip); else it slides along them.
    pub no_slip: bool,
    /// The fluid.
    pub fluid: FluidParams,
    /// The sponges, in the order of the scene.
    pub sponges: Vec<SpongeParams>,
    /// Nodes that stay as they are, because their sponges are asleep.
    pub asleep: Asleep,
    /// Smoothing between nodes and particles; its support is the suction radius.
    pub coupling: Wendland,
    /// Smoothing of the volume of the sponges' material, where that displaces fluid: none with the paper's coupling.
    pub solid: Option<Wendland>,
    /// Whether particles in sponges exchange momentum with the corners of their tets instead of all nodes around them.
    pub is_barycentric: bool,
}

impl Params {
    /// Whether a property of any sponge depends on how wet it is.
    #[must_use]
    pub fn has_wetting(&self) -> bool {
        self.sponges.iter().any(|sponge| sponge.wetting.is_any())
    }

    /// Whether any sponge can touch another or itself: those that `vbd` solves.
    #[must_use]
    pub fn has_touch(&self) -> bool {
        (0..self.sponges.len() as u32).any(|sponge| self.meets_any(sponge))
    }

    /// Whether any of these sponges can touch another one of them or itself.
    #[must_use]
    pub fn has_touch_among(&self, sponges: &[u32]) -> bool {
        sponges.iter().any(|sponge| sponges.iter().any(|other| self.may_meet(*sponge, *other)))
    }

    /// Whether a sponge can touch another or itself.
    pub(crate) fn meets_any(&self, sponge: u32) -> bool {
        (0..self.sponges.len() as u32).any(|other| self.may_meet(sponge, other))
    }

    /// Whether two sponges, or one and itself, can touch.
    pub(crate) fn may_meet(&self, a: u32, b: u32) -> bool {
        let [own, other] = [a, b].map(|index| &self.sponges[index as usize]);
        own.solver == Solver::Vbd && other.solver == Solver::Vbd && (a != b || own.self_contact)
    }

    /// Edge that contact of two sponges is measured in \[m\].
    pub(crate) fn pair_edge(&self, a: u32, b: u32) -> f32 {
        let [a, b] = [a, b].map(|index| self.sponges[index as usize].contact_edge());
        a.max(b)
    }

    /// Harmonic mean of the moduli of two sponges \[Pa\].
    pub(crate) fn pair_modulus(&self, a: u32, b: u32) -> f32 {
        let [a, b] = [a, b].map(|index| &self.sponges[index as usize]).map(|own| own.lambda + own.mu);
        2.0 * a * b / (a + b)
    }

    /// Coulomb friction between two sponges \[1\].
    pub(crate) fn pair_friction(&self, a: u32, b: u32) -> f32 {
        0.5 * (self.sponges[a as usize].friction + self.sponges[b as usize].friction)
    }

    /// How a sponge is solved; none for what is no sponge, as in padding rows.
    #[must_use]
    pub(crate) fn solver(&self, sponge: u32) -> Option<Solver> {
        self.sponges.get(sponge as usize).map(|sponge| sponge.solver)
    }
}

enumeration! {
    /// How pressure follows from density.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum EquationOfState {
        /// `p = c^2 (rho - rho_0)`.
        Linear,
        /// `p = rho_0 c^2 / 7 ((rho / rho_0)^7 - 1)`.
        Tait,
    }
}

/// A solve for the pressure that keeps the density at rest density.
#[derive(Clone, Debug)]
pub struct Incompressible {
    /// Mean error of the density, of either sign, at which the solve stops \[1\].
    pub tolerance: f32,
    /// Most rounds of a step.
    pub rounds: u32,
    /// Rounds of a step in which positions are moved instead \[MM13\]; none where the pressure is solved for.
    pub projections: Option<u32>,
    /// Diagonal of a lattice at rest, over the square of the step \[1/m^2\].
    pub lattice_diagonal: f32,
    /// Speed at which an error of the density may be put right \[m/s\].
    pub correction_speed: f32,
    /// Distance at which walls and bodies begin to count \[m\].
    pub boundary_range: f32,
    /// Their share at the surface \[1\].
    pub boundary_share: f32,
    /// Where the solve is for the divergence of the velocities.
    pub divergence: Option<Divergence>,
}

/// What the pressure solve for the divergence of the velocities needs beside that for the density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Divergence {
    /// Second moment of the neighbourhood of a particle in a lattice at rest: 1 for a perfect smoothing function.
    pub lattice_moment: f32,
    /// First moment of the neighbourhood of the first layer of a lattice below a plane \[1/m\].
    pub surface_moment: f32,
    /// Part of the neighbourhood that it lacks \[1\].
    pub surface_lack: f32,
    /// Smallest mass of a body, over the same and half of what the body displaces \[1\]: a light body makes the system stiffer.
    pub lightest: f32,
}

/// What holds the edges of films and drops on walls and bodies (`divergence::retention`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Retention {
    /// Deceleration per density that is missing \[m^4/(kg s^2)\].
    pub strength: f32,
    /// Density of a film one particle thick \[kg/m^3\]: what has less has an edge.
    pub density: f32,
    /// Distance from a surface within which particles lie on it \[m\].
    pub range: f32,
}

impl Retention {
    /// Deceleration that the edge at a particle bears \[m/s^2\].
    #[must_use]
    pub fn deceleration(&self, density: f32) -> f32 {
        self.strength * (self.density - density).max(0.0)
    }
}

/// Viscosity as a solve for the velocities at the end of the step (`sph::viscosity_begin`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitViscosity {
    /// Dynamic viscosity between all velocities of neighbours \[Pa s\].
    pub viscosity: f32,
    /// Dynamic viscosity between their velocities along the line between them \[Pa s\].
    pub central_viscosity: f32,
    /// Residual over the change of the velocities, both as roots of mean squares, at which the solve stops \[1\].
    pub tolerance: f32,
    /// Most rounds of a step.
    pub rounds: u32,
}

/// An energy of the surface of the fluid (`sph::deficit`, `sph::cohesion`).
#[derive(Clone, Debug)]
pub struct Cohesion {
    /// Energy density per energy of a deficit \[Pa\].
    pub stiffness: f32,
    /// What deficits are measured with: twice as wide as that between particles.
    pub smoothing: Wendland,
    /// Volume of a particle with which a lattice at rest has no deficit \[m^3\].
    pub volume: f32,
}

constants! {
    /// Time in which the compression of a particle follows the roughness of the pressure, over the root of the roughness \[1\].
    const ROUGHNESS_DELAY: f32 = 8.0;

    /// Roughness that a step follows at once, over the square of the step: what is less is stable in any case.
    const PROMPT_ROUGHNESS: f32 = 0.2;

    /// Volume of a tet over that at rest below which the logarithm in the energy of `vbd` goes on as a polynomial \[1\].
    pub const POLYNOMIAL_RATIO: f64 = 0.2;

    /// Interior value above which a particle counts as inside a sponge: its value at a flat surface \[1\].
    pub const INSIDE: f32 = 0.5;

    /// Saturation above which a node counts as wet \[1\].
    pub const WET: f32 = 0.5;
}

impl FluidParams {
    /// How far the neighbours in the lists may be \[m\].
    #[must_use]
    pub fn list_radius(&self) -> f32 {
        self.cohesion.as_ref().map_or(self.smoothing.support_radius, |own| own.smoothing.support_radius)
    }

    /// Volume of a particle at rest density \[m^3\].
    #[must_use]
    pub fn rest_volume(&self) -> f32 {
        self.particle_mass / self.rest_density
    }

    /// Parameters of a pressure solve for the divergence of the velocities, where that is the solver.
    #[must_use]
    pub fn divergence(&self) -> Option<&Divergence> {
        self.incompressible.as_ref()?.divergence.as_ref()
    }

    /// What of [`roughness`](Self::roughness) the compression of a single step may follow \[s^2\]; see `sph::predict`.
    #[must_use]
    pub fn prompt_roughness(&self, step: f32) -> f32 {
        let delayed = self.roughness * step / (step + ROUGHNESS_DELAY * self.roughness.sqrt());
        let maximum = delayed.max(PROMPT_ROUGHNESS * step * step);
        if maximum < self.roughness { maximum } else { self.roughness }
    }
}

/// The fluid.
#[derive(Clone, Debug)]
pub struct FluidParams {
    /// Distance of particles at rest \[m\].
    pub spacing: f32,
    /// Density at rest \[kg/m^3\].
    pub rest_density: f32,
    /// Mass of a particle \[kg\], such that a lattice at rest has the rest density.
    pub particle_mass: f32,
    /// Smoothing between particles.
    pub smoothing: Wendland,
    /// How pressure follows from density.
    pub equation_of_state: EquationOfState,
    /// Speed of sound c \[m/s\].
    pub sound_speed: f32,
    /// The solve for the pressure; none where it follows from an equation of state.
    pub incompressible: Option<Incompressible>,
    /// Dynamic viscosity between all velocities of neighbours, of `sph::forces` \[Pa s\].
    pub viscosity: f32,
    /// Dynamic viscosity between their velocities along the line between them, of `sph::forces` \[Pa s\].
    pub central_viscosity: f32,
    /// Dynamic viscosity by the rate of strain, as part of the forces or of the solve \[Pa s\].
    pub strain_viscosity: f32,
    /// All viscosity as a solve; none where it is part of the forces.
    pub implicit_viscosity: Option<ImplicitViscosity>,
    /// Compression that is allowed for the roughness of the pressure, over that roughness \[s^2\]; see `sph::factors`.
    pub roughness: f32,
    /// Dynamic viscosity between the fluid and walls and bodies that it does not slide along \[Pa s\].
    pub wall_viscosity: f32,
    /// What holds films and drops on walls and bodies.
    pub retention: Option<Retention>,
    /// Surface tension, where it comes from the colour field \[N/m\].
    pub surface_tension: f32,
    /// Surface tension from an energy of the surface.
    pub cohesion: Option<Cohesion>,
    /// Distance at which walls and bodies begin to push \[m\].
    pub repulsion_range: f32,
    /// Acceleration per depth into that range \[1/s^2\].
    pub repulsion_stiffness: f32,
    /// Deceleration per approach speed inside that range \[1/s\].
    pub repulsion_damping: f32,
}

impl Params {
    /// Where coordinates are taken from where their size would cost digits: the middle of the container, or the origin.
    #[must_use]
    pub(crate) fn origin(&self) -> Vec3 {
        let middle = self.walls.map_or(Vec3::ZERO, |(low, high)| 0.5 * (low + high));
        self.periodic.map_or(middle, |periodic| periodic.centred(middle))
    }
}
