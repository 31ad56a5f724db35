//! Contents of a scene, and why a phase is skipped.

use crate::{
    body::Body,
    columns::{Columns, RowCounts},
    need::Need,
    params::{Params, Solver, SpongeParams},
};

/// The awake contents of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Contents<'a> {
    /// Parameters of the step.
    pub params: &'a Params,
    /// Rows of the stores; none of sleeping particles, and none of nodes if all sponges sleep.
    pub rows: RowCounts,
    /// The rigid bodies.
    pub bodies: &'a [Body],
    /// Whether awake sponges can touch each other or themselves.
    pub touch: bool,
}

impl<'a> Contents<'a> {
    /// All contents of a scene, awake.
    #[must_use]
    pub fn new(params: &'a Params, columns: &'a Columns) -> Self {
        Self { params, rows: columns.rows, bodies: &columns.bodies.states.0, touch: params.has_touch() }
    }

    /// The sponges; none if there are no nodes of them.
    #[must_use]
    pub fn sponges(&self) -> &'a [SpongeParams] {
        if self.rows.nodes > 0 { &self.params.sponges } else { &[] }
    }

    /// Whether a solver has a sponge.
    fn has_solver(&self, solver: Solver) -> bool {
        self.sponges().iter().any(|sponge| sponge.solver == solver)
    }
}

impl Need {
    /// Why a phase with this need is skipped; none if the need is met.
    #[must_use]
    pub fn missing(self, contents: &Contents<'_>) -> Option<&'static str> {
        let (is_met, reason) = self.condition(contents);
        (!is_met).then_some(reason)
    }

    /// Whether the need is met, and the reason if it is not.
    fn condition(self, contents: &Contents<'_>) -> (bool, &'static str) {
        let Contents { params, rows, bodies, touch } = contents;
        let fluid = &params.fluid;
        match self {
            Self::Fluid => (rows.fluid > 0, "no fluid"),
            Self::Sponge => (rows.nodes > 0, "no sponge"),
            Self::Solver(solver) => (
                contents.has_solver(solver),
                match solver {
                    Solver::Sbd => "no sponge with solver sbd",
                    Solver::Vbd => "no sponge with solver vbd",
                    Solver::XpbdNeoHookean => "no sponge with solver xpbd_neo_hookean",
                },
            ),
            Self::Projection => (
                contents.has_solver(Solver::Sbd) || contents.has_solver(Solver::XpbdNeoHookean),
                "no sponge with solver sbd or xpbd_neo_hookean",
            ),
            Self::Obstacles => (params.walls.is_some() || rows.bodies > 0, "no walls and no bodies"),
            Self::Bodies => (rows.bodies > 0, "no bodies"),
            Self::SurfaceTension => (fluid.surface_tension > 0.0, "no surface tension from the colour field"),
            Self::Cohesion => (fluid.cohesion.is_some(), "no surface tension by cohesion"),
            Self::NoSlip => {
                let sticks = params.no_slip || bodies.iter().any(|body| body.no_slip);
                (sticks && fluid.wall_viscosity > 0.0, "fluid slides along everything")
            }
            Self::Retention => (fluid.retention.is_some(), "films and drops do not stick"),
            Self::ExplicitViscosity => (fluid.implicit_viscosity.is_none(), "viscosity is implicit"),
            Self::StrainRate => (fluid.strain_viscosity > 0.0, "no viscosity by the rate of strain"),
            Self::ImplicitViscosity => (fluid.implicit_viscosity.is_some(), "viscosity is explicit"),
            Self::NoSponges => (rows.nodes == 0, "sponges take a part of the pressure"),
            Self::EquationOfState => (fluid.incompressible.is_none(), "pressure is solved for"),
            Self::Incompressible => (fluid.incompressible.is_some(), "pressure by an equation of state"),
            Self::Density => (
                fluid.incompressible.is_some() && fluid.divergence().is_none(),
                "no pressure solve for the density",
            ),
            Self::Divergence => (fluid.divergence().is_some(), "no pressure solve for the divergence"),
            Self::Porous => (params.solid.is_some(), "coupling of the paper"),
            Self::Barycentric => (params.is_barycentric, "smoothed coupling weights"),
            Self::Smoothed => (!params.is_barycentric, "barycentric coupling weights"),
            Self::Wetting => (params.has_wetting(), "no sponge depends on how wet it is"),
            Self::Touch => (*touch, "no sponge can touch another or itself"),
        }
    }
}
