//! The table of twins: which passes make up a kernel on the GPU, over which rows, bound to which buffers.

/// How many threads or groups a pass needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rows {
    /// One thread.
    One,
    /// A thread per particle.
    Fluid,
    /// A thread per node.
    Nodes,
    /// Thirty-two threads per control.
    Controls,
    /// A thread per particle or node, whichever are more.
    FluidOrNodes,
    /// A group per page of the cells over the particles.
    FluidPages,
    /// A group per page of the cells over the controls.
    ControlPages,
    /// One group if the cells over the particles have many pages.
    FluidScan,
    /// One group if the cells over the controls have many pages.
    ControlScan,
    /// A group per page of the cells over the nodes that may touch.
    PairPages,
    /// One group if those cells have many pages.
    PairScan,
    /// A thread per tet.
    Tets,
    /// A group per body.
    Bodies,
    /// A thread per tet of a colour, and a pass per colour.
    Colors,
    /// A thread per node of a vertex colour, and a pass per vertex colour.
    VertexColors,
    /// A group per sponge.
    Sponges,
}

/// One pass of a twin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pass {
    /// Name of the shader, `family::file`.
    pub(super) shader: &'static str,
    pub(super) entry: &'static str,
    pub(super) rows: Rows,
    /// Bindings whose buffer has another name than the variable.
    pub(super) names: Names,
}

type Names = &'static [(&'static str, &'static str)];

const fn pass(shader: &'static str, rows: Rows, names: Names) -> Pass {
    Pass { shader, entry: "main", rows, names }
}

/// Particles in the order of this step, and their lists.
const FLUID: Names = &[
    ("position", "fluid_position_sorted"),
    ("velocity", "fluid_velocity_sorted"),
    ("acceleration", "fluid_acceleration"),
    ("density", "fluid_density"),
    ("predicted", "fluid_predicted"),
    ("boundary", "fluid_boundary"),
    ("deficit", "fluid_deficit"),
    ("factors", "fluid_factors"),
    ("pressure_rows", "fluid_pressure_rows"),
    ("correction", "fluid_correction"),
    ("drag_rate", "fluid_drag_rate"),
    ("solid_yield", "fluid_yield"),
    ("friction", "fluid_friction"),
    ("friction_between", "fluid_friction_between"),
    ("viscosity_residual", "fluid_viscosity_residual"),
    ("viscosity_direction", "fluid_viscosity_direction"),
    ("viscosity_product", "fluid_viscosity_product"),
    ("viscosity_change", "fluid_viscosity_change"),
    ("list", "fluid_neighbors"),
    ("grid", "fluid_grid"),
    ("starts", "fluid_starts"),
    ("wrenches", "fluid_wrenches"),
];

/// Particles before and after the sort.
const SORT: Names = &[
    ("position", "fluid_position"),
    ("velocity", "fluid_velocity"),
    ("id", "fluid_id"),
    ("sorted_position", "fluid_position_sorted"),
    ("sorted_velocity", "fluid_velocity_sorted"),
    ("sorted_id", "fluid_id_sorted"),
    ("points", "fluid_position"),
    ("grid", "fluid_grid"),
    ("cells", "fluid_cells"),
    ("slots", "fluid_slots"),
    ("counts", "fluid_counts"),
    ("starts", "fluid_starts"),
    ("page_sums", "fluid_page_sums"),
    ("grouped", "fluid_grouped"),
];

/// Nodes before and after they are sorted as controls.
const CONTROLS: Names = &[
    ("points", "node_position"),
    ("grid", "control_grid"),
    ("cells", "control_cells"),
    ("slots", "control_slots"),
    ("counts", "control_counts"),
    ("starts", "control_starts"),
    ("page_sums", "control_page_sums"),
    ("grouped", "control_grouped"),
];

/// Nodes in the cells over those that may touch.
const PAIRS: Names = &[
    ("points", "node_position"),
    ("grid", "pair_grid"),
    ("cells", "pair_cells"),
    ("slots", "pair_slots"),
    ("counts", "pair_counts"),
    ("starts", "pair_starts"),
    ("page_sums", "pair_page_sums"),
    ("grouped", "pair_grouped"),
];

/// Controls around every particle.
const NEAR_FLUID: Names = &[
    ("queries", "fluid_position_sorted"),
    ("points", "control_position"),
    ("grid", "control_grid"),
    ("starts", "control_starts"),
    ("list", "fluid_controls"),
];

/// Particles around every control.
const NEAR_CONTROLS: Names = &[
    ("queries", "control_position"),
    ("points", "fluid_position_sorted"),
    ("grid", "fluid_grid"),
    ("starts", "fluid_starts"),
    ("list", "control_fluid"),
];

/// What particles take from the controls around them.
const FROM_CONTROLS: Names = &[
    ("position", "fluid_position_sorted"),
    ("velocity", "fluid_velocity_sorted"),
    ("acceleration", "fluid_acceleration"),
    ("interior", "fluid_interior"),
    ("drag_rate", "fluid_drag_rate"),
    ("drag", "fluid_drag"),
    ("predicted", "fluid_predicted"),
    ("boundary", "fluid_boundary"),
    ("list", "fluid_controls"),
];

/// What controls take from the particles around them.
const FROM_FLUID: Names = &[
    ("position", "fluid_position_sorted"),
    ("interior", "fluid_interior"),
    ("drag", "fluid_drag"),
    ("unfiltered", "control_unfiltered"),
    ("predicted", "fluid_predicted"),
    ("free", "node_free"),
    ("goal", "node_target"),
    ("list", "control_fluid"),
];

const NODES: Names = &[
    ("position", "node_position"),
    ("velocity", "node_velocity"),
    ("acceleration", "node_acceleration"),
    ("grip", "node_grip"),
    ("grip_offset", "node_grip_offset"),
    ("predicted", "node_predicted"),
    ("free", "node_free"),
    ("goal", "node_target"),
    ("drag", "node_drag"),
    ("drag_moment", "node_drag_moment"),
    ("reaction", "node_reaction"),
    ("pores", "node_pores"),
    ("stars", "node_stars"),
    ("ranges", "sponge_ranges"),
    ("boxes", "sponge_boxes"),
    ("rest", "node_rest"),
    ("normal", "node_normal"),
    ("touch", "node_touch"),
    ("stiffness", "node_touch_stiffness"),
    ("between", "node_touch_between"),
    ("list", "node_pairs"),
    ("grid", "pair_grid"),
    ("starts", "pair_starts"),
    ("grouped", "pair_grouped"),
    ("motions", "sponge_motions"),
    ("wrenches", "node_wrenches"),
];

/// Whether lists fit; the last of a step is enough, since nothing before it writes what survives.
pub(super) const CHECK: Pass = Pass { shader: "clock::clock", entry: "check", rows: Rows::One, names: &[] };

/// Before the first step of a batch.
pub(super) const BEGIN: Pass = Pass { shader: "clock::clock", entry: "begin", rows: Rows::One, names: &[] };
/// After the last phase of a step.
pub(super) const FINISH: Pass = Pass { shader: "clock::clock", entry: "finish", rows: Rows::One, names: &[] };
/// After a round of a repetition that ends when it has converged.
pub(super) const END_ROUND: Pass =
    Pass { shader: "clock::rounds", entry: "end_round", rows: Rows::One, names: &[] };
/// After the last of its rounds.
pub(super) const END_ROUNDS: Pass =
    Pass { shader: "clock::rounds", entry: "end_rounds", rows: Rows::One, names: &[] };
/// Before more rounds, where those that were handed in did not suffice.
pub(super) const RESUME: Pass = Pass { shader: "clock::clock", entry: "resume", rows: Rows::One, names: &[] };
/// Before bodies can move.
pub(super) const BODY_WRENCHES: Pass = pass("sph::body_wrenches", Rows::Bodies, &[]);

/// Sums over particles, nodes and tets, and where each is among the totals.
pub(super) const SUMS: [Pass; 3] = [
    pass("measure::fluid", Rows::Fluid, MEASURED_FLUID),
    pass("measure::nodes", Rows::Nodes, NODES),
    pass("measure::tets", Rows::Tets, NODES),
];
/// The sums of all groups of one of [`SUMS`].
pub(super) const TOTAL: Pass = pass("measure::total", Rows::One, &[]);

/// Particles after a step.
const MEASURED_FLUID: Names = &[
    ("position", "fluid_position"),
    ("velocity", "fluid_velocity"),
    ("density", "fluid_density"),
    ("interior", "fluid_interior"),
];

/// The passes of every twin.
pub(super) static TWINS: &[(&str, &[Pass])] = &[
    (
        "grid::sort_fluid",
        &[
            pass("grid::count", Rows::Fluid, SORT),
            pass("grid::scan_sums", Rows::FluidScan, SORT),
            pass("grid::scan_pages", Rows::FluidPages, SORT),
            pass("grid::scatter", Rows::Fluid, SORT),
            pass("grid::sort_fluid", Rows::Fluid, SORT),
        ],
    ),
    ("grid::fluid_neighbors", &[pass("grid::fluid_neighbors", Rows::Fluid, FLUID), CHECK]),
    ("sph::density", &[pass("sph::density", Rows::Fluid, FLUID)]),
    ("sph::pressure", &[pass("sph::pressure", Rows::Fluid, FLUID)]),
    ("sph::forces", &[pass("sph::forces", Rows::Fluid, FLUID)]),
    ("sph::surface_tension", &[pass("sph::surface_tension", Rows::Fluid, FLUID)]),
    ("sph::deficit", &[pass("sph::deficit", Rows::Fluid, FLUID)]),
    ("sph::cohesion", &[pass("sph::cohesion", Rows::Fluid, FLUID)]),
    ("sph::repulsion", &[pass("sph::repulsion", Rows::Fluid, FLUID)]),
    ("sph::kick", &[pass("sph::kick", Rows::Fluid, FLUID)]),
    ("sph::boundary_pressure", &[pass("sph::boundary_pressure", Rows::Fluid, FLUID)]),
    ("sph::wall_friction", &[pass("sph::wall_friction", Rows::Fluid, FLUID)]),
    (
        "sph::viscosity_begin",
        &[
            pass("sph::viscosity_friction", Rows::Fluid, FLUID),
            pass("sph::viscosity_begin", Rows::Fluid, FLUID),
        ],
    ),
    (
        "sph::viscosity_product",
        &[
            pass("sph::viscosity_product", Rows::Fluid, FLUID),
            pass("sph::viscosity_length", Rows::One, FLUID),
        ],
    ),
    (
        "sph::viscosity_update",
        &[pass("sph::viscosity_update", Rows::Fluid, FLUID), pass("sph::viscosity_round", Rows::One, FLUID)],
    ),
    ("sph::viscosity_reaction", &[pass("sph::viscosity_reaction", Rows::Fluid, FLUID)]),
    ("sph::viscosity_kick", &[pass("sph::viscosity_kick", Rows::Fluid, FLUID)]),
    ("sph::predict", &[pass("sph::predict", Rows::Fluid, FLUID)]),
    ("sph::boundary", &[pass("sph::boundary", Rows::Fluid, FLUID)]),
    ("sph::factors", &[pass("sph::factors", Rows::Fluid, FLUID), pass("sph::solve_begin", Rows::One, FLUID)]),
    ("sph::pressure_update", &[pass("sph::pressure_update", Rows::Fluid, FLUID)]),
    ("sph::pressure_acceleration", &[pass("sph::pressure_acceleration", Rows::Fluid, FLUID)]),
    (
        "sph::pressure_residual",
        &[pass("sph::pressure_residual", Rows::Fluid, FLUID), pass("sph::solve_round", Rows::One, FLUID)],
    ),
    ("sph::pressure_kick", &[pass("sph::pressure_kick", Rows::Fluid, FLUID)]),
    ("sph::position_correction", &[pass("sph::position_correction", Rows::Fluid, FLUID)]),
    ("sph::boundary_reaction", &[pass("sph::boundary_reaction", Rows::Fluid, FLUID)]),
    ("sph::sweep", &[pass("sph::sweep", Rows::Fluid, FLUID)]),
    ("sph::advect", &[pass("sph::advect", Rows::Fluid, SORT)]),
    (
        "pbd::pairs",
        &[
            pass("pbd::boxes", Rows::Sponges, NODES),
            pass("pbd::normals", Rows::Nodes, NODES),
            pass("grid::count", Rows::Nodes, PAIRS),
            pass("grid::scan_sums", Rows::PairScan, PAIRS),
            pass("grid::scan_pages", Rows::PairPages, PAIRS),
            pass("grid::scatter", Rows::Nodes, PAIRS),
            pass("pbd::pairs", Rows::Nodes, NODES),
            CHECK,
        ],
    ),
    (
        "pbd::touch",
        &[
            pass("pbd::touch", Rows::Nodes, NODES),
            pass("pbd::touching", Rows::Sponges, NODES),
            pass("pbd::joining", Rows::One, NODES),
        ],
    ),
    ("pbd::gravity", &[pass("pbd::gravity", Rows::Nodes, NODES)]),
    ("pbd::predict", &[pass("pbd::predict", Rows::Nodes, NODES)]),
    ("pbd::guess", &[pass("pbd::guess", Rows::Nodes, NODES)]),
    ("pbd::xpbd_neo_hookean", &[pass("pbd::xpbd_neo_hookean", Rows::Colors, NODES)]),
    ("pbd::vbd", &[pass("pbd::vbd", Rows::VertexColors, NODES)]),
    ("pbd::reaction", &[pass("pbd::reaction", Rows::Nodes, NODES)]),
    (
        "pbd::momentum",
        &[
            pass("pbd::momentum_sums", Rows::Sponges, NODES),
            pass("pbd::momentum", Rows::Nodes, NODES),
            pass("pbd::momentum_bodies", Rows::Nodes, NODES),
        ],
    ),
    ("pbd::strain", &[pass("pbd::strain", Rows::Colors, NODES)]),
    ("pbd::contact", &[pass("pbd::contact", Rows::Nodes, NODES)]),
    ("pbd::velocity", &[pass("pbd::velocity", Rows::Nodes, NODES)]),
    (
        "couple::controls",
        &[
            pass("grid::count", Rows::Nodes, CONTROLS),
            pass("grid::scan_sums", Rows::ControlScan, CONTROLS),
            pass("grid::scan_pages", Rows::ControlPages, CONTROLS),
            pass("grid::scatter", Rows::Nodes, CONTROLS),
            pass("couple::controls", Rows::Nodes, CONTROLS),
            pass("couple::near_fluid", Rows::Fluid, NEAR_FLUID),
            pass("couple::near_controls", Rows::Controls, NEAR_CONTROLS),
            CHECK,
        ],
    ),
    ("couple::saturation", &[pass("couple::saturation", Rows::Controls, FROM_FLUID)]),
    ("couple::wetting", &[pass("couple::wetting", Rows::Nodes, NODES)]),
    ("couple::pores", &[pass("couple::pores", Rows::Nodes, NODES)]),
    ("couple::interior", &[pass("couple::interior", Rows::Fluid, FROM_CONTROLS)]),
    ("couple::suction", &[pass("couple::suction", Rows::Fluid, FROM_CONTROLS)]),
    ("couple::zero_distance", &[pass("couple::zero_distance", Rows::Controls, FROM_FLUID)]),
    (
        "couple::control_velocity",
        &[
            pass("couple::begin_drag", Rows::FluidOrNodes, FROM_FLUID),
            pass("couple::control_velocity", Rows::Controls, FROM_FLUID),
        ],
    ),
    ("couple::drag", &[pass("couple::drag", Rows::Fluid, FROM_CONTROLS)]),
    ("couple::velocity_filter", &[pass("couple::velocity_filter", Rows::Controls, FROM_FLUID)]),
    (
        "couple::exchange",
        &[
            pass("couple::exchange", Rows::Controls, FROM_FLUID),
            pass("couple::exchange_fluid", Rows::Fluid, FROM_CONTROLS),
        ],
    ),
    (
        "couple::solid_pressure",
        &[
            pass("couple::expect_solid", Rows::Nodes, FROM_FLUID),
            pass("couple::solid_pressure", Rows::Fluid, FROM_CONTROLS),
        ],
    ),
    ("couple::solid_share", &[pass("couple::solid_share", Rows::Fluid, FROM_CONTROLS)]),
    ("couple::solid_yield", &[pass("couple::solid_yield", Rows::Fluid, FLUID)]),
    ("couple::solid_reaction", &[pass("couple::solid_reaction", Rows::Controls, FROM_FLUID)]),
    ("couple::node_velocity", &[pass("couple::node_velocity", Rows::Nodes, FROM_FLUID)]),
    ("couple::drag_impulse", &[pass("couple::drag_impulse", Rows::Fluid, FROM_CONTROLS)]),
    ("couple::drag_target", &[pass("couple::drag_target", Rows::Controls, FROM_FLUID)]),
    ("couple::drag_reaction", &[pass("couple::drag_reaction", Rows::Controls, FROM_FLUID)]),
    ("couple::drag_settled", &[pass("couple::drag_settled", Rows::Nodes, FROM_FLUID)]),
    ("couple::drag_kick", &[pass("couple::exchange_fluid", Rows::Fluid, FROM_CONTROLS)]),
];

/// The passes of a kernel, if it has a twin.
pub(super) fn twin(kernel: &str) -> Option<&'static [Pass]> {
    TWINS.iter().find(|(name, _)| *name == kernel).map(|(_, passes)| *passes)
}

impl Pass {
    /// The buffer that a variable is bound to.
    pub(super) fn buffer(&self, variable: &'static str) -> &'static str {
        self.names.iter().find(|(name, _)| *name == variable).map_or(variable, |(_, buffer)| buffer)
    }
}
