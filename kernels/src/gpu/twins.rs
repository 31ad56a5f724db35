//! What declarations of kernels say of their twins: passes, over which rows, bound to which buffers.

/// How many threads or groups a pass needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
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
pub(crate) struct Pass {
    /// Name of the shader, `family::file`.
    pub(crate) shader: &'static str,
    pub(crate) entry: &'static str,
    pub(crate) rows: Rows,
    /// Bindings whose buffer has another name than the variable.
    pub(crate) names: Names,
}

pub(crate) type Names = &'static [(&'static str, &'static str)];

pub(crate) const fn pass(shader: &'static str, rows: Rows, names: Names) -> Pass {
    Pass { shader, entry: "main", rows, names }
}

/// Particles in the order of this step, and their lists.
pub(crate) const FLUID: Names = &[
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
pub(crate) const SORT: Names = &[
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
pub(crate) const CONTROLS: Names = &[
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
pub(crate) const PAIRS: Names = &[
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
pub(crate) const NEAR_FLUID: Names = &[
    ("queries", "fluid_position_sorted"),
    ("points", "control_position"),
    ("grid", "control_grid"),
    ("starts", "control_starts"),
    ("list", "fluid_controls"),
];

/// Particles around every control.
pub(crate) const NEAR_CONTROLS: Names = &[
    ("queries", "control_position"),
    ("points", "fluid_position_sorted"),
    ("grid", "fluid_grid"),
    ("starts", "fluid_starts"),
    ("list", "control_fluid"),
];

/// What particles take from the controls around them.
pub(crate) const FROM_CONTROLS: Names = &[
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
pub(crate) const FROM_FLUID: Names = &[
    ("position", "fluid_position_sorted"),
    ("interior", "fluid_interior"),
    ("drag", "fluid_drag"),
    ("unfiltered", "control_unfiltered"),
    ("predicted", "fluid_predicted"),
    ("free", "node_free"),
    ("goal", "node_target"),
    ("list", "control_fluid"),
];

pub(crate) const NODES: Names = &[
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
pub(crate) const CHECK: Pass = Pass { shader: "clock::clock", entry: "check", rows: Rows::One, names: &[] };

/// Before the first step of a batch.
pub(crate) const BEGIN: Pass = Pass { shader: "clock::clock", entry: "begin", rows: Rows::One, names: &[] };
/// After the last phase of a step.
pub(crate) const FINISH: Pass = Pass { shader: "clock::clock", entry: "finish", rows: Rows::One, names: &[] };
/// After a round of a repetition that ends when it has converged.
pub(crate) const END_ROUND: Pass =
    Pass { shader: "clock::rounds", entry: "end_round", rows: Rows::One, names: &[] };
/// After the last of its rounds.
pub(crate) const END_ROUNDS: Pass =
    Pass { shader: "clock::rounds", entry: "end_rounds", rows: Rows::One, names: &[] };
/// Before more rounds, where those that were handed in did not suffice.
pub(crate) const RESUME: Pass = Pass { shader: "clock::clock", entry: "resume", rows: Rows::One, names: &[] };
/// Before bodies can move.
pub(crate) const BODY_WRENCHES: Pass = pass("sph::body_wrenches", Rows::Bodies, &[]);

/// Sums over particles, nodes and tets, and where each is among the totals.
pub(crate) const SUMS: [Pass; 3] = [
    pass("measure::fluid", Rows::Fluid, MEASURED_FLUID),
    pass("measure::nodes", Rows::Nodes, NODES),
    pass("measure::tets", Rows::Tets, NODES),
];
/// The sums of all groups of one of [`SUMS`].
pub(crate) const TOTAL: Pass = pass("measure::total", Rows::One, &[]);

/// Particles after a step.
pub(crate) const MEASURED_FLUID: Names = &[
    ("position", "fluid_position"),
    ("velocity", "fluid_velocity"),
    ("density", "fluid_density"),
    ("interior", "fluid_interior"),
];

impl Pass {
    /// The buffer that a variable is bound to.
    pub(crate) fn buffer(&self, variable: &'static str) -> &'static str {
        self.names.iter().find(|(name, _)| *name == variable).map_or(variable, |(_, buffer)| buffer)
    }
}
