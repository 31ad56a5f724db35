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
    /// A group per page of the numbers of images of the particles.
    ImageLinePages,
    /// One group if those have many pages.
    ImageLineScan,
    /// A thread per image that there is room for.
    Images,
    /// The same where there are bodies, else none.
    ImagesOfBodies,
    /// A thread per particle where there are bodies, else none.
    FluidBesideBodies,
    /// A group per page of the cells over the images.
    ImagePages,
    /// One group if those cells have many pages.
    ImageScan,
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
    /// A group per part of a sponge.
    SpongeParts,
    /// A group per sponge where sponges have several parts, else none.
    DividedSponges,
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

/// A pass whose variables have the names of buffers.
pub(crate) const fn pass(shader: &'static str, rows: Rows) -> Pass {
    Pass { shader, entry: "main", rows, names: &[] }
}

/// Cells over the particles that the step before left.
pub(crate) const FLUID_CELLS: Names = &[
    ("points", "fluid_position_next"),
    ("grid", "fluid_grid"),
    ("cells", "fluid_cells"),
    ("slots", "fluid_slots"),
    ("counts", "fluid_counts"),
    ("starts", "fluid_starts"),
    ("page_sums", "fluid_page_sums"),
    ("grouped", "fluid_grouped"),
];

/// Cells over the nodes, which are sorted as controls.
pub(crate) const CONTROL_CELLS: Names = &[
    ("points", "node_position"),
    ("grid", "control_grid"),
    ("cells", "control_cells"),
    ("slots", "control_slots"),
    ("counts", "control_counts"),
    ("starts", "control_starts"),
    ("page_sums", "control_page_sums"),
    ("grouped", "control_grouped"),
];

/// Cells over the nodes that may touch.
pub(crate) const PAIR_CELLS: Names = &[
    ("points", "node_position"),
    ("grid", "pair_grid"),
    ("cells", "pair_cells"),
    ("slots", "pair_slots"),
    ("counts", "pair_counts"),
    ("starts", "pair_starts"),
    ("page_sums", "pair_page_sums"),
    ("grouped", "pair_grouped"),
];

/// Numbers of images of the particles.
pub(crate) const IMAGE_LINE: Names = &[
    ("grid", "image_line"),
    ("counts", "image_line_counts"),
    ("starts", "fluid_image_first"),
    ("page_sums", "image_line_sums"),
];

/// Cells over the images.
pub(crate) const IMAGE_CELLS: Names = &[
    ("points", "image_position"),
    ("grid", "image_grid"),
    ("cells", "image_cells"),
    ("slots", "image_slots"),
    ("counts", "image_counts"),
    ("starts", "image_starts"),
    ("page_sums", "image_page_sums"),
    ("grouped", "image_grouped"),
];

/// Whether lists fit; the last of a step is enough, since nothing before it writes what survives.
pub(crate) const CHECK: Pass = Pass { shader: "clock::clock", entry: "check", rows: Rows::One, names: &[] };

/// Before the first step of a batch.
pub(crate) const BEGIN: Pass = Pass { shader: "clock::clock", entry: "begin", rows: Rows::One, names: &[] };
/// After the last phase of a step.
pub(crate) const FINISH: Pass = Pass { shader: "clock::clock", entry: "finish", rows: Rows::One, names: &[] };
/// Entry point of the last pass of a round of a repetition that ends when it has converged: it ends the round.
pub(crate) const LAST: &str = "last";
/// After the last round of such a repetition.
pub(crate) const END_ROUNDS: Pass =
    Pass { shader: "clock::rounds", entry: "end_rounds", rows: Rows::One, names: &[] };
/// Before more rounds, where those that were submitted did not suffice.
pub(crate) const RESUME: Pass = Pass { shader: "clock::clock", entry: "resume", rows: Rows::One, names: &[] };
/// Before bodies can move.
pub(crate) const BODY_WRENCHES: Pass = pass("sph::body_wrenches", Rows::Bodies);

/// Sums over particles, nodes and tets, and where each is among the totals.
pub(crate) const SUMS: [Pass; 3] = [
    pass("measure::fluid", Rows::Fluid),
    pass("measure::nodes", Rows::Nodes),
    pass("measure::tets", Rows::Tets),
];
/// The sums of all groups of one of [`SUMS`].
pub(crate) const TOTAL: Pass = pass("measure::total", Rows::One);

/// What a turn of the container does to the velocities of the particles between two steps.
pub(crate) const TURN_PARTICLES: Pass = Pass {
    shader: "frame::turn",
    entry: "particles",
    rows: Rows::Fluid,
    names: &[("positions", "fluid_position_next"), ("velocities", "fluid_velocity_next")],
};
/// The same to those of the nodes.
pub(crate) const TURN_NODES: Pass = Pass {
    shader: "frame::turn",
    entry: "nodes",
    rows: Rows::Nodes,
    names: &[("positions", "node_position"), ("velocities", "node_velocity")],
};

/// Particles where a step leaves them.
const PARTICLES: Names =
    &[("fluid_position", "fluid_position_next"), ("fluid_velocity", "fluid_velocity_next")];
/// The water around points, the sponges that they lie in, and where rays meet water: a group for each.
pub(crate) const QUERY_POINTS: Pass = pass("query::points", Rows::One).on(PARTICLES);
pub(crate) const QUERY_SPONGES: Pass = pass("query::sponges", Rows::One);
pub(crate) const QUERY_RAYS: Pass = pass("query::rays", Rows::One).on(PARTICLES);

impl Pass {
    /// The same pass on other buffers.
    pub(crate) const fn on(self, names: Names) -> Self {
        Self { names, ..self }
    }

    /// The same pass from another entry point.
    pub(crate) const fn from(self, entry: &'static str) -> Self {
        Self { entry, ..self }
    }

    /// The buffer that a variable is bound to.
    pub(crate) fn buffer(&self, variable: &'static str) -> &'static str {
        self.names.iter().find(|(name, _)| *name == variable).map_or(variable, |(_, buffer)| buffer)
    }
}
