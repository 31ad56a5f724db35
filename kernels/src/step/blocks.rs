//! The blocks that a step is made of.

use crate::{couple, divergence, grid, need::Need, pbd, sph, tets};

use super::{
    Block,
    Phase::{self, Host, KeepDensity, Repeat, Run, With},
    RIGID, Solve, Times,
};

/// Particles in the order of their cells, their neighbours and their density.
pub(super) static SEARCH: Block = Block {
    name: "search",
    phases: &[
        Run(&grid::sort_fluid::KERNEL),
        Run(&grid::fluid_neighbors::KERNEL),
        Run(&sph::density::KERNEL),
    ],
};

/// Images of the particles in walls and bodies, the material of sponges, and the moments of neighbourhoods with both.
pub(super) static IMAGES: Block = Block {
    name: "images",
    phases: &[
        Run(&divergence::images::KERNEL),
        Run(&couple::solid_expect::KERNEL),
        Run(&couple::solid_moments::KERNEL),
        Run(&tets::moments::KERNEL),
        Run(&divergence::moments::KERNEL),
        Run(&couple::solid_diagonal::KERNEL),
        Run(&tets::corners::KERNEL),
        Run(&tets::flux::KERNEL),
        Run(&tets::mobility::KERNEL),
    ],
};

/// Nodes as control particles of the fluid, pairs of nodes that may touch, and the saturation around the nodes.
pub(super) static CONTROLS: Block = Block {
    name: "controls",
    phases: &[Run(&couple::controls::KERNEL), Run(&pbd::pairs::KERNEL), Run(&couple::saturation::KERNEL)],
};

/// Porosity, interior values of particles, and the suction on sponges.
pub(super) static PORES: Block = Block {
    name: "pores",
    phases: &[
        Run(&couple::pores::KERNEL),
        Run(&couple::interior::KERNEL),
        Run(&pbd::gravity::KERNEL),
        Run(&couple::zero_distance::KERNEL),
    ],
};

/// Forces between particles, and of sponges on them.
pub(super) static FORCES: Block = Block {
    name: "forces",
    phases: &[
        Run(&sph::forces::KERNEL),
        Run(&sph::spin::KERNEL),
        Run(&sph::strain_rate::KERNEL),
        Run(&sph::surface_tension::KERNEL),
        Run(&sph::deficit::KERNEL),
        Run(&sph::cohesion::KERNEL),
        Run(&couple::suction::KERNEL),
    ],
};

/// Forces of walls and bodies on particles.
pub(super) static WALLS: Block = Block {
    name: "walls",
    phases: &[
        Run(&sph::boundary_pressure::KERNEL),
        Run(&divergence::hydrostatic::KERNEL),
        Run(&sph::adhesion::KERNEL),
        Run(&sph::wall_friction::KERNEL),
    ],
};

/// Damping of velocities that differ from particle to particle.
pub(super) static NOISE: Block =
    Block { name: "noise", phases: &[Run(&divergence::approach::KERNEL), Run(&divergence::damping::KERNEL)] };

/// Velocities by the forces, and by a solve for implicit viscosity. That solve has the pressure of the last step, so that viscosity resists
/// what pressure does.
pub(super) static VISCOSITY: Block = Block {
    name: "viscosity",
    phases: &[
        Run(&sph::kick::KERNEL),
        With {
            needs: &[Need::ImplicitViscosity, Need::NoSponges],
            phases: &[
                Run(&divergence::expect::KERNEL),
                Run(&divergence::update::KERNEL),
                Run(&divergence::acceleration::KERNEL),
                Run(&divergence::pressure_guess::KERNEL),
            ],
        },
        Run(&sph::viscosity_start::KERNEL),
        Run(&sph::viscosity_spin::KERNEL),
        Run(&sph::viscosity_strain::KERNEL),
        Run(&sph::viscosity_begin::KERNEL),
        Repeat {
            times: Times::UntilConverged(Solve::Viscosity),
            phases: &[
                Run(&sph::viscosity_spin::KERNEL),
                Run(&sph::viscosity_strain::KERNEL),
                Run(&sph::viscosity_product::KERNEL),
                Run(&sph::viscosity_update::KERNEL),
            ],
        },
        Run(&sph::viscosity_reaction::KERNEL),
        Run(&sph::viscosity_kick::KERNEL),
        Run(&divergence::pressure_return::KERNEL),
    ],
};

/// Keeps the density, where there is no equation of state.
pub(super) static PRESSURE: Block = Block {
    name: "pressure",
    phases: &[KeepDensity { solve: SOLVE, divergence: DIVERGENCE, projection: PROJECTION }],
};

/// The density by a pressure solve \[BK17\].
static SOLVE: &[Phase] = &[
    Run(&sph::predict::KERNEL),
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
    // While the position still has the pressure of the previous step beside it.
    Run(&couple::solid_reaction::KERNEL),
    Run(&sph::pressure_kick::KERNEL),
    Run(&sph::boundary_reaction::KERNEL),
];

/// The density by moving particles \[MM13\]: every iteration begins at the positions of the previous one.
static PROJECTION: &[Phase] = &[
    Run(&sph::predict::KERNEL),
    Repeat {
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
    },
];

/// The divergence of the velocities by a pressure solve, with the bodies as unknowns.
static DIVERGENCE: &[Phase] = &[
    Run(&divergence::expect::KERNEL),
    Repeat {
        times: Times::UntilConverged(Solve::Pressure),
        phases: &[
            Run(&divergence::update::KERNEL),
            Run(&divergence::acceleration::KERNEL),
            Run(&couple::solid_response::KERNEL),
            Run(&couple::solid_velocity::KERNEL),
            Run(&tets::response::KERNEL),
            Run(&tets::velocity::KERNEL),
            Run(&divergence::residual::KERNEL),
        ],
    },
    Run(&couple::solid_kick::KERNEL),
    Run(&divergence::kick::KERNEL),
];

/// Sponges by any of the solvers, with their contacts.
pub(super) static ELASTIC: Block = Block {
    name: "elastic",
    phases: &[
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
    ],
};

/// Sweeps of the drag before the last. Water may weigh 20 times as much as the sponge it fills. Two then leave the impulses of a uniform
/// flow within 6 % of the converged ones. Those of a shear flow are within 8 %. Momentum is exact and energy falls at any number.
const FILTER_SWEEPS: u32 = 2;

/// The drag between fluid and sponges, after everything else.
pub(super) static DRAG: Block = Block {
    name: "drag",
    phases: &[
        Run(&couple::control_velocity::KERNEL),
        Repeat {
            times: Times::Fixed(FILTER_SWEEPS),
            phases: &[Run(&couple::drag::KERNEL), Run(&couple::velocity_filter::KERNEL)],
        },
        Run(&couple::drag::KERNEL),
        Run(&couple::exchange::KERNEL),
        Run(&couple::drag_kick::KERNEL),
    ],
};

/// Number of momentum corrections of sponges before the drag is fixed: the drag responds to the rigid motion of a sponge.
const BALANCES: u32 = 2;

/// Sponges by vertex block descent, with the drag of the fluid and their contacts.
pub(super) static ELASTIC_WITH_DRAG: Block = Block {
    name: "elastic with drag",
    phases: &[
        Run(&pbd::predict::KERNEL),
        Run(&pbd::guess::KERNEL),
        Repeat {
            times: Times::SolverIterations,
            phases: &[
                Run(&couple::drag_impulse::KERNEL),
                Run(&tets::drag_impulse::KERNEL),
                Run(&couple::drag_target::KERNEL),
                Run(&tets::drag_target::KERNEL),
                Run(&pbd::touch::KERNEL),
                Run(&pbd::vbd::KERNEL),
            ],
        },
        Run(&couple::drag_impulse::KERNEL),
        Run(&tets::drag_impulse::KERNEL),
        Run(&couple::drag_target::KERNEL),
        Run(&tets::drag_target::KERNEL),
        Run(&pbd::touch::KERNEL),
        Run(&pbd::reaction::KERNEL),
        Repeat {
            times: Times::Fixed(BALANCES),
            phases: &[
                Run(&couple::drag_reaction::KERNEL),
                Run(&tets::drag_reaction::KERNEL),
                Run(&pbd::momentum::KERNEL),
                Run(&couple::drag_impulse::KERNEL),
                Run(&tets::drag_impulse::KERNEL),
            ],
        },
        Run(&couple::drag_settled::KERNEL),
        Run(&tets::drag_settled::KERNEL),
        Run(&pbd::momentum::KERNEL),
        Run(&couple::drag_kick::KERNEL),
        Run(&tets::drag_kick::KERNEL),
        Run(&pbd::velocity::KERNEL),
    ],
};

/// Particles and bodies at the end of the step.
pub(super) static MOTION: Block = Block {
    name: "motion",
    phases: &[
        Run(&divergence::retention::KERNEL),
        Run(&divergence::shift::KERNEL),
        Run(&sph::sweep::KERNEL),
        Run(&sph::advect::KERNEL),
        Host(&RIGID),
    ],
};
