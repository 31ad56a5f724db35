//! The whole step, in the order of the paper's Figure 2: blocks in two orders.

mod blocks;

use crate::{columns::Column, contents::Contents, couple, kernel::Kernel, need::Need, sph};

/// One line of the step.
#[derive(Debug)]
pub enum Phase {
    /// A kernel.
    Run(&'static Kernel),
    /// Phases that belong together.
    Named(&'static Block),
    /// Phases that are run several times.
    Repeat {
        /// How often.
        times: Times,
        /// What is repeated.
        phases: &'static [Self],
    },
    /// Phases that a scene without all of `needs` has no use for, although the kernels alone might run.
    With {
        /// What the scene must contain.
        needs: &'static [Need],
        /// Phases, in order.
        phases: &'static [Self],
    },
    /// Keeps the density of the fluid, where there is no equation of state.
    KeepDensity {
        /// By a solve for the pressure.
        solve: &'static [Self],
        /// By a solve for the pressure that keeps the divergence of the velocities.
        divergence: &'static [Self],
        /// By moving particles.
        projection: &'static [Self],
    },
    /// Something that the host does between kernels.
    Host(&'static HostPhase),
}

/// Phases that belong together, under a name.
#[derive(Debug)]
pub struct Block {
    /// Its name in the figure of a step.
    pub name: &'static str,
    /// Its phases, in order.
    pub phases: &'static [Phase],
}

/// How often phases are repeated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Times {
    /// As often as the sponge that asks for most: `sponges[..].iterations`.
    SolverIterations,
    /// As often as `fluid.projections` says.
    Projections,
    /// A fixed number.
    Fixed(u32),
    /// Until a solve has converged.
    UntilConverged(Solve),
}

/// A solve whose rounds end when it has converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solve {
    /// For the pressure, at most `fluid.rounds` rounds.
    Pressure,
    /// For the velocities with implicit viscosity, at most `fluid.viscosity_rounds` rounds.
    Viscosity,
}

impl Phase {
    /// The phases that keep the density of the fluid of a scene.
    #[must_use]
    pub fn kept(
        [solve, divergence, projection]: [&'static [Self]; 3],
        contents: &Contents<'_>,
    ) -> &'static [Self] {
        if contents.params.fluid.divergence().is_some() {
            divergence
        } else if Times::Projections.number(contents) > 0 {
            projection
        } else {
            solve
        }
    }
}

impl Times {
    /// How often for a scene; for rounds until convergence at most.
    #[must_use]
    pub fn number(self, contents: &Contents<'_>) -> u32 {
        let fluid = &contents.params.fluid;
        match self {
            Self::SolverIterations => {
                contents.sponges().iter().map(|sponge| sponge.iterations).max().unwrap_or(0)
            }
            Self::Projections => {
                fluid.incompressible.as_ref().and_then(|solve| solve.projections).unwrap_or(0)
            }
            Self::Fixed(times) => times,
            Self::UntilConverged(Solve::Pressure) => {
                fluid.incompressible.as_ref().map_or(0, |solve| solve.rounds)
            }
            Self::UntilConverged(Solve::Viscosity) => {
                fluid.implicit_viscosity.map_or(0, |implicit| implicit.rounds)
            }
        }
    }
}

/// A phase of the host.
#[derive(Debug, PartialEq, Eq)]
pub struct HostPhase {
    /// `family::name`.
    pub name: &'static str,
    /// What the scene must contain; all of these.
    pub needs: &'static [Need],
    /// What it changes.
    pub writes: &'static [Column],
    /// Columns that it reads, if they were written before it.
    pub reads: &'static [Column],
}

/// The rigid bodies receive the wrenches of fluid and sponges, and move.
pub static RIGID: HostPhase = HostPhase {
    name: "rigid::step",
    needs: &[Need::Bodies],
    writes: &[Column::BodyStates],
    reads: &[Column::BodyFluidWrenches, Column::BodyNodeWrenches],
};

use Phase::{Named, Run};
use blocks::*;

/// The step of the paper. Reads and writes of the kernels check this order; they do not define it.
pub static STEP: &[Phase] = &[
    Named(&SEARCH),
    Named(&IMAGES),
    Run(&sph::pressure::KERNEL),
    Named(&CONTROLS),
    Named(&PORES),
    Named(&ELASTIC),
    Named(&FORCES),
    Run(&sph::repulsion::KERNEL),
    Named(&WALLS),
    Named(&NOISE),
    Named(&VISCOSITY),
    Named(&PRESSURE),
    Named(&DRAG),
    Named(&MOTION),
];

/// The step with sponges as porous media: pressure and suction first, then elasticity, drag and contact as one solve. The
/// sponge then bears the loads of the water in the same step, and drag slows suction and pressure alike (docs/porous.md).
pub static POROUS_STEP: &[Phase] = &[
    Named(&SEARCH),
    Named(&CONTROLS),
    Run(&couple::wetting::KERNEL),
    Run(&couple::contact_suction::KERNEL),
    Named(&PORES),
    Named(&IMAGES),
    Named(&FORCES),
    Named(&WALLS),
    Named(&NOISE),
    Run(&couple::solid_pressure::KERNEL),
    Named(&VISCOSITY),
    Named(&PRESSURE),
    Named(&ELASTIC_WITH_DRAG),
    Named(&MOTION),
];
