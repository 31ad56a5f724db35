//! How long a step may be: what bounds it, and the numbers of the bounds that host and device find from step to step.

use crate::layout::{constants, enumeration};

enumeration! {
    /// What limited a step.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    #[non_exhaustive]
    pub enum Bound {
        /// `time.maximum_step`.
        Maximum,
        /// The end of the frame.
        Frame,
        /// Sound and flow cross a support radius \[M92\].
        Courant,
        /// Acceleration over a support radius.
        Acceleration,
        /// Diffusion of velocity over a support radius. Where viscosity is implicit it is a hundred times that, and what stops a body
        /// that the fluid does not slide along.
        Viscosity,
        /// Capillary waves.
        SurfaceTension,
        /// Suction against the mass of a dry node.
        Suction,
        /// Elastic waves of a dry sponge cross some part of the lattice constant, which depends on its solver.
        Elasticity,
        /// Nodes cross a quarter of the lattice constant.
        SpongeSpeed,
        /// Pressure moves a particle against its neighbours.
        Pressure,
        /// The surface of a body crosses the same as fluid and nodes may.
        BodySpeed,
        /// None: the scene is asleep, see `Time::sleep_after`.
        Asleep,
    }
}

impl Bound {
    /// Name as it appears in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Maximum => "maximum_step",
            Self::Frame => "frame",
            Self::Courant => "courant",
            Self::Acceleration => "acceleration",
            Self::Viscosity => "viscosity",
            Self::SurfaceTension => "surface_tension",
            Self::Suction => "suction",
            Self::Elasticity => "elasticity",
            Self::SpongeSpeed => "sponge_speed",
            Self::Pressure => "pressure",
            Self::BodySpeed => "body_speed",
            Self::Asleep => "asleep",
        }
    }
}

constants! {
    /// Step over the time in which pressure moves a particle by a spacing. At twice that the lattice of a pool at rest buckles
    /// (docs/pressure-solve.md).
    pub const PRESSURE_COURANT: f32 = 0.4;

    /// Largest pressure of a column at rest over the root of the mean of its square: the root of three.
    pub const PEAK_PRESSURE: f32 = 1.732_050_8;

    /// Step over the root of support radius over acceleration \[M92\].
    pub const ACCELERATION_COURANT: f32 = 0.25;

    /// Part of a lattice constant that nodes and surfaces of bodies may cross in a step.
    pub const LATTICE_COURANT: f32 = 0.25;

    /// Step that no speed of a body makes shorter, over the shortest that is allowed. A script may move a body at any speed; what is
    /// faster than this is swept.
    pub const SHORTEST_BY_BODY: f32 = 10.0;

    /// Part of a step by which a frame may be longer than equal steps fill. A step that has been cut must not be cut to one more piece by
    /// rounding.
    pub const CUT_TOLERANCE: f64 = 1e-4;

    /// Time that counts as nothing \[s\].
    pub const TIME_RESOLUTION: f64 = 1e-9;
}

/// The part of the bounds that does not change from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Factor on support radius over speed of sound and flow \[1\].
    pub courant: f32,
    /// Smallest lattice constant of the sponges that are awake \[m\]; infinite without any.
    pub edge: f32,
    /// Whether there is fluid, and it is awake.
    pub has_fluid: bool,
    /// Shortest step that is allowed \[s\].
    pub minimum: f32,
    /// Smallest of the bounds that do not change \[s\].
    pub constant: f32,
    /// Which that is.
    pub constant_bound: Bound,
}

impl StepLimits {
    /// Distance that the surface of a body may go in a step, with a fluid of this support radius \[m\].
    #[must_use]
    pub fn reach_of_bodies(&self, support_radius: f32) -> f32 {
        let by_fluid = if self.has_fluid { self.courant * support_radius } else { f32::INFINITY };
        by_fluid.min(LATTICE_COURANT * self.edge)
    }
}
