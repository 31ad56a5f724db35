//! The whole step, in the order of the paper's Figure 2.

use sorb_kernels::{
    columns::Column,
    couple, grid,
    kernel::Kernel,
    need::{Contents, Need},
    pbd, sph,
};

/// One line of the step.
#[derive(Debug)]
pub enum Phase {
    /// A kernel.
    Run(&'static Kernel),
    /// Phases that are run several times.
    Repeat {
        /// How often.
        times: Times,
        /// What is repeated.
        phases: &'static [Self],
    },
    /// What keeps the density of the fluid, where that is no matter of an equation of state.
    KeepDensity {
        /// By a solve for the pressure.
        solve: &'static [Self],
        /// By moving particles.
        projection: &'static [Self],
    },
    /// Something that the host does between kernels.
    Host(&'static HostPhase),
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

impl Times {
    /// How often for a scene; for rounds until convergence at most.
    pub(super) fn number(self, contents: &Contents<'_>) -> u32 {
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

/// A phase that is not a kernel.
#[derive(Debug, PartialEq, Eq)]
pub struct HostPhase {
    /// `family::name`.
    pub name: &'static str,
    /// What the scene must contain; all of these.
    pub needs: &'static [Need],
    /// What it changes.
    pub writes: &'static [Column],
    /// What it uses of what was written before it, if anything was.
    pub reads: &'static [Column],
}

/// The rigid bodies take what fluid and sponges gave them, and move.
pub static RIGID: HostPhase = HostPhase {
    name: "rigid::step",
    needs: &[Need::Bodies],
    writes: &[Column::BodyStates],
    reads: &[Column::BodyFluidWrenches, Column::BodyNodeWrenches],
};

/// Sweeps of the drag before the last: for water that weighs 20 times as much as the sponge it fills, two leave the
/// impulses of a uniform flow within 6 % and of a shear flow within 8 % of the converged ones. Momentum is exact and
/// energy falls at any number.
pub(super) const FILTER_SWEEPS: u32 = 2;

use Phase::{Host, KeepDensity, Repeat, Run};

/// The density by a solve for the pressure \[BK17\].
static SOLVE: &[Phase] = &[
    Run(&sph::boundary::KERNEL),
    Run(&couple::solid_share::KERNEL),
    Run(&sph::factors::KERNEL),
    Repeat {
        times: Times::UntilConverged(Solve::Pressure),
        phases: &[
            Run(&sph::pressure_update::KERNEL),
            Run(&sph::pressure_acceleration::KERNEL),
            Run(&couple::solid_yield::KERNEL),
            Run(&sph::pressure_residual::KERNEL),
        ],
    },
    // While the position still has the pressure of the step before beside it.
    Run(&couple::solid_reaction::KERNEL),
    Run(&sph::pressure_kick::KERNEL),
    Run(&sph::boundary_reaction::KERNEL),
];

/// The density by moving particles \[MM13\]: every round begins at the positions that the one before has left.
static PROJECTION: &[Phase] = &[Repeat {
    times: Times::Projections,
    phases: &[
        Run(&sph::boundary::KERNEL),
        Run(&couple::solid_share::KERNEL),
        Run(&sph::factors::KERNEL),
        Run(&sph::pressure_update::KERNEL),
        Run(&sph::pressure_acceleration::KERNEL),
        Run(&couple::solid_reaction::KERNEL),
        Run(&sph::boundary_reaction::KERNEL),
        Run(&sph::position_correction::KERNEL),
    ],
}];

/// The step. Reads and writes of the kernels check this order; they do not make it.
pub static STEP: &[Phase] = &[
    Run(&grid::sort_fluid::KERNEL),
    Run(&grid::fluid_neighbors::KERNEL),
    Run(&sph::density::KERNEL),
    Run(&sph::pressure::KERNEL),
    Run(&couple::controls::KERNEL),
    Run(&pbd::pairs::KERNEL),
    Run(&couple::saturation::KERNEL),
    Run(&couple::pores::KERNEL),
    Run(&couple::interior::KERNEL),
    Run(&pbd::gravity::KERNEL),
    Run(&couple::zero_distance::KERNEL),
    Run(&pbd::predict::KERNEL),
    Run(&pbd::guess::KERNEL),
    Repeat {
        times: Times::SolverIterations,
        phases: &[
            Run(&pbd::strain::KERNEL),
            Run(&pbd::xpbd_neo_hookean::KERNEL),
            Run(&pbd::touch::KERNEL),
            Run(&pbd::vbd::KERNEL),
            Run(&pbd::contact::KERNEL),
        ],
    },
    Run(&pbd::touch::KERNEL),
    Run(&pbd::reaction::KERNEL),
    Run(&pbd::momentum::KERNEL),
    Run(&pbd::velocity::KERNEL),
    Run(&sph::forces::KERNEL),
    Run(&sph::surface_tension::KERNEL),
    Run(&sph::deficit::KERNEL),
    Run(&sph::cohesion::KERNEL),
    Run(&couple::suction::KERNEL),
    Run(&sph::repulsion::KERNEL),
    Run(&sph::boundary_pressure::KERNEL),
    Run(&sph::wall_friction::KERNEL),
    Run(&sph::kick::KERNEL),
    Run(&sph::viscosity_begin::KERNEL),
    Repeat {
        times: Times::UntilConverged(Solve::Viscosity),
        phases: &[Run(&sph::viscosity_product::KERNEL), Run(&sph::viscosity_update::KERNEL)],
    },
    Run(&sph::viscosity_reaction::KERNEL),
    Run(&sph::viscosity_kick::KERNEL),
    Run(&sph::predict::KERNEL),
    KeepDensity { solve: SOLVE, projection: PROJECTION },
    Run(&couple::control_velocity::KERNEL),
    Repeat {
        times: Times::Fixed(FILTER_SWEEPS),
        phases: &[Run(&couple::drag::KERNEL), Run(&couple::velocity_filter::KERNEL)],
    },
    Run(&couple::drag::KERNEL),
    Run(&couple::exchange::KERNEL),
    Run(&sph::sweep::KERNEL),
    Run(&sph::advect::KERNEL),
    Host(&RIGID),
];

/// How often the momenta of sponges are balanced before the drag is settled: it answers to the rigid motion that a sponge is given, at places that lie
/// around its nodes somehow.
const BALANCES: u32 = 2;

/// The step with sponges as porous media: pressure and suction first, then elasticity, drag and contact as one solve, so
/// that the sponge bears what the water does to it, and drag does not weaken suction but not pressure (docs/porous.md).
pub static POROUS_STEP: &[Phase] = &[
    Run(&grid::sort_fluid::KERNEL),
    Run(&grid::fluid_neighbors::KERNEL),
    Run(&sph::density::KERNEL),
    Run(&couple::controls::KERNEL),
    Run(&pbd::pairs::KERNEL),
    Run(&couple::saturation::KERNEL),
    Run(&couple::wetting::KERNEL),
    Run(&couple::pores::KERNEL),
    Run(&couple::interior::KERNEL),
    Run(&pbd::gravity::KERNEL),
    Run(&couple::zero_distance::KERNEL),
    Run(&sph::forces::KERNEL),
    Run(&sph::surface_tension::KERNEL),
    Run(&sph::deficit::KERNEL),
    Run(&sph::cohesion::KERNEL),
    Run(&couple::suction::KERNEL),
    Run(&sph::boundary_pressure::KERNEL),
    Run(&sph::wall_friction::KERNEL),
    Run(&couple::solid_pressure::KERNEL),
    Run(&sph::kick::KERNEL),
    Run(&sph::viscosity_begin::KERNEL),
    Repeat {
        times: Times::UntilConverged(Solve::Viscosity),
        phases: &[Run(&sph::viscosity_product::KERNEL), Run(&sph::viscosity_update::KERNEL)],
    },
    Run(&sph::viscosity_reaction::KERNEL),
    Run(&sph::viscosity_kick::KERNEL),
    Run(&sph::predict::KERNEL),
    KeepDensity { solve: SOLVE, projection: PROJECTION },
    Run(&pbd::predict::KERNEL),
    Run(&pbd::guess::KERNEL),
    Repeat {
        times: Times::SolverIterations,
        phases: &[
            Run(&couple::node_velocity::KERNEL),
            Run(&couple::drag_impulse::KERNEL),
            Run(&couple::drag_target::KERNEL),
            Run(&pbd::touch::KERNEL),
            Run(&pbd::vbd::KERNEL),
        ],
    },
    Run(&couple::node_velocity::KERNEL),
    Run(&couple::drag_impulse::KERNEL),
    Run(&couple::drag_target::KERNEL),
    Run(&pbd::touch::KERNEL),
    Run(&pbd::reaction::KERNEL),
    Repeat {
        times: Times::Fixed(BALANCES),
        phases: &[
            Run(&couple::drag_reaction::KERNEL),
            Run(&pbd::momentum::KERNEL),
            Run(&couple::node_velocity::KERNEL),
            Run(&couple::drag_impulse::KERNEL),
        ],
    },
    Run(&couple::drag_reaction::KERNEL),
    Run(&couple::drag_settled::KERNEL),
    Run(&pbd::momentum::KERNEL),
    Run(&couple::drag_kick::KERNEL),
    Run(&pbd::velocity::KERNEL),
    Run(&sph::sweep::KERNEL),
    Run(&sph::advect::KERNEL),
    Host(&RIGID),
];
