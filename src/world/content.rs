//! What a scene contains.

use sorb_kernels::{
    columns::Columns,
    params::{Params, Solver},
};

use crate::schedule::Content;

/// What a scene contains, as far as phases depend on it.
pub(super) fn content(columns: &Columns, params: &Params) -> Content {
    Content {
        fluid: columns.rows.fluid > 0,
        sponge: columns.rows.nodes > 0,
        solvers: [Solver::Sbd, Solver::Vbd, Solver::XpbdNeoHookean]
            .map(|solver| params.sponges.iter().any(|sponge| sponge.solver == solver).then_some(solver)),
        walls: params.walls.is_some(),
        bodies: columns.rows.bodies > 0,
        surface_tension: params.fluid.surface_tension > 0.0,
        cohesion: params.fluid.cohesion.is_some(),
        no_slip: params.fluid.wall_viscosity > 0.0
            && (params.no_slip || columns.bodies.states.0.iter().any(|body| body.no_slip)),
        porous: params.solid.is_some(),
        wetting: params.has_wetting(),
        touch: params.has_touch(),
        rounds: params.fluid.incompressible.as_ref().map_or(0, |solve| solve.rounds),
        projections: params.fluid.incompressible.as_ref().and_then(|solve| solve.projections).unwrap_or(0),
        viscosity_rounds: params.fluid.implicit_viscosity.map_or(0, |implicit| implicit.rounds),
        iterations: params.sponges.iter().map(|sponge| sponge.iterations).max().unwrap_or(0),
    }
}
