//! Parameters, sponges, bodies and batches as shaders have them.

use super::{
    capacities::{Capacities, List},
    layout::{Value, WORD_BYTES, place_of, zero},
};
use crate::{
    clock::{Bound, StepLimits},
    columns::RowCounts,
    layout::{constants, layout},
    params::{
        Cohesion, Divergence, EquationOfState, ImplicitViscosity, Incompressible, Params, Retention,
        SpongeParams,
    },
    pbd::{
        lattice::{COLORS, Topology, VERTEX_COLORS},
        meeting::pair_radius,
    },
    smoothing::Wendland,
};

constants! {
    /// Most sponges that fit the uniform buffer.
    pub(super) const SPONGES: usize = 256;
    /// Beside the solver of a sponge that is asleep: none of them moves it. Nothing that is awake is within its reach.
    const ASLEEP: u32 = 4;
}

/// Batches: colours of tets, then colours of nodes.
pub(super) const BATCHES: usize = COLORS + VERTEX_COLORS;
/// Bytes from one batch to the next: the alignment that every device takes.
pub(super) const BATCH_STRIDE: u64 = 256;

layout! {
    /// Parameters of a step; zero is what there is not. What is not said here is as in [`Params`].
    #[derive(Clone, Debug)]
    pub(super) struct StepParams as Params {
        gravity: [f32; 3],
        /// Corners of the container, out of reach along axes without walls.
        wall_low: [f32; 3],
        has_walls: bool,
        wall_high: [f32; 3],
        fluid_rows: u32,
        node_rows: u32,
        body_rows: u32,
        tet_rows: u32,
        spacing: f32,
        rest_density: f32,
        particle_mass: f32,
        equation_of_state: EquationOfState,
        sound_speed: f32,
        viscosity: f32,
        central_viscosity: f32,
        strain_viscosity: f32,
        surface_tension: f32,
        repulsion_range: f32,
        repulsion_stiffness: f32,
        repulsion_damping: f32,
        roughness: f32,
        wall_viscosity: f32,
        /// What holds films and drops; all zero where nothing does.
        retention_strength: f32,
        retention_density: f32,
        retention_range: f32,
        no_slip: bool,
        /// Whether a property of a sponge depends on how wet it is.
        has_wetting: bool,
        /// How far apart nodes that touch can be; 0 where nothing can.
        pair_radius: f32,
        /// How far the neighbours in the lists of particles may be.
        list_radius: f32,
        /// Entries that fit a list.
        neighbor_capacity: u32,
        control_capacity: u32,
        control_fluid_capacity: u32,
        near_image_capacity: u32,
        image_particle_capacity: u32,
        /// Images that there is room for.
        image_capacity: u32,
        smoothing: Wendland,
        coupling: Wendland,
        solid: Wendland,
        cohesion: Wendland,
        cohesion_stiffness: f32,
        cohesion_volume: f32,
        /// Whether pressure is solved for; the next six are those of the solve.
        incompressible: bool,
        solve_tolerance: f32,
        solve_rounds: u32,
        lattice_diagonal: f32,
        correction_speed: f32,
        boundary_range: f32,
        boundary_share: f32,
        /// Whether that is for the divergence of the velocities; the next four are those of such a solve.
        divergence: bool,
        lattice_moment: f32,
        surface_moment: f32,
        surface_lack: f32,
        lightest: f32,
        implicit_viscosity: f32,
        implicit_central_viscosity: f32,
        viscosity_tolerance: f32,
        viscosity_rounds: u32,
        /// The part of the bounds of a step that does not change, as [`StepLimits`].
        courant: f32,
        edge: f32,
        has_moving_fluid: bool,
        minimum_step: f32,
        constant_step: f32,
        constant_bound: Bound,
        /// Where coordinates are taken from where their size would cost digits.
        middle: [f32; 3],
        /// The box that repeats.
        period_low: [f32; 3],
        has_periods: bool,
        period_high: [f32; 3],
        /// Its length along the axes on which it repeats, 0 along the others.
        periods: [f32; 3],
        /// Half of the periods; along the other axes farther than any two points are apart.
        half_periods: [f32; 3],
    }
}

impl StepParams {
    pub(super) fn new(params: &Params, rows: RowCounts, limits: &StepLimits, capacities: Capacities) -> Self {
        let fluid = &params.fluid;
        let [fluid_rows, node_rows, body_rows, tet_rows] =
            [rows.fluid, rows.nodes, rows.bodies, rows.tets].map(|rows| rows as u32);
        let capacity = |list: List| list.capacity(capacities) as u32;
        let mut all = Self {
            gravity: params.gravity.to_array(),
            fluid_rows,
            node_rows,
            body_rows,
            tet_rows,
            spacing: fluid.spacing,
            rest_density: fluid.rest_density,
            particle_mass: fluid.particle_mass,
            equation_of_state: fluid.equation_of_state,
            sound_speed: fluid.sound_speed,
            viscosity: fluid.viscosity,
            central_viscosity: fluid.central_viscosity,
            strain_viscosity: fluid.strain_viscosity,
            surface_tension: fluid.surface_tension,
            repulsion_range: fluid.repulsion_range,
            repulsion_stiffness: fluid.repulsion_stiffness,
            repulsion_damping: fluid.repulsion_damping,
            roughness: fluid.roughness,
            wall_viscosity: fluid.wall_viscosity,
            no_slip: params.no_slip,
            has_wetting: params.has_wetting(),
            pair_radius: pair_radius(params),
            list_radius: fluid.list_radius(),
            neighbor_capacity: capacity(List::Neighbors),
            control_capacity: capacity(List::Controls),
            control_fluid_capacity: capacity(List::ControlFluid),
            near_image_capacity: capacity(List::NearImages),
            image_particle_capacity: capacity(List::ImageParticles),
            image_capacity: capacity(List::Images),
            smoothing: fluid.smoothing,
            coupling: params.coupling,
            solid: params.solid.unwrap_or(params.coupling),
            courant: limits.courant,
            // Finite: shaders may assume that nothing is infinite.
            edge: limits.edge.min(f32::MAX),
            has_moving_fluid: limits.has_fluid,
            minimum_step: limits.minimum,
            constant_step: limits.constant,
            constant_bound: limits.constant_bound,
            middle: params.origin().to_array(),
            ..zero()
        };
        all.add_optional(params);
        all
    }

    /// What only some scenes have.
    fn add_optional(&mut self, params: &Params) {
        if let Some((low, high)) = params.walls {
            (self.has_walls, self.wall_low, self.wall_high) = (true, low.to_array(), high.to_array());
        }
        if let Some(solve) = &params.fluid.incompressible {
            self.incompressible = true;
            let Incompressible { lattice_diagonal, correction_speed, boundary_range, boundary_share, .. } =
                *solve;
            (self.solve_tolerance, self.solve_rounds) = (solve.tolerance, solve.rounds);
            (self.lattice_diagonal, self.correction_speed) = (lattice_diagonal, correction_speed);
            (self.boundary_range, self.boundary_share) = (boundary_range, boundary_share);
        }
        if let Some(own) = params.fluid.divergence() {
            let Divergence { lattice_moment, surface_moment, surface_lack, lightest } = *own;
            (self.divergence, self.lattice_moment) = (true, lattice_moment);
            (self.surface_moment, self.surface_lack, self.lightest) =
                (surface_moment, surface_lack, lightest);
        }
        if let Some(Retention { strength, density, range }) = params.fluid.retention {
            (self.retention_strength, self.retention_density, self.retention_range) =
                (strength, density, range);
        }
        if let Some(Cohesion { stiffness, smoothing, volume }) = &params.fluid.cohesion {
            self.cohesion = *smoothing;
            (self.cohesion_stiffness, self.cohesion_volume) = (*stiffness, *volume);
        }
        if let Some(ImplicitViscosity { viscosity, central_viscosity, tolerance, rounds }) =
            params.fluid.implicit_viscosity
        {
            (self.implicit_viscosity, self.implicit_central_viscosity) = (viscosity, central_viscosity);
            (self.viscosity_tolerance, self.viscosity_rounds) = (tolerance, rounds);
        }
        if let Some(periodic) = &params.periodic {
            let (low, high) = periodic.corners();
            (self.has_periods, self.period_low, self.period_high) = (true, low.to_array(), high.to_array());
            self.periods = periodic.periods().to_array();
            self.half_periods = periodic.halves().to_array();
        }
    }
}

/// Sponges, of whose nodes `first` has the first of each.
pub(super) fn sponges(params: &Params, first: &[usize]) -> Vec<u32> {
    let mut words = Vec::new();
    for (sponge, first) in params.sponges.iter().zip(first) {
        let mut own = sponge.words();
        if params.asleep.has(*first) {
            own[place_of::<SpongeParams>("solver")] |= ASLEEP;
        }
        words.extend(own);
    }
    words.resize(SPONGES * SpongeParams::WORDS, 0);
    words
}

layout! {
    /// First tet or node of a batch, and number of them.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub(super) struct Batch {
        pub(super) first: u32,
        pub(super) count: u32,
    }
}

layout! {
    /// What a device knows of a repetition that ends when it has converged.
    #[derive(Clone, Copy, Debug)]
    pub(super) struct Repetition {
        pub(super) maximum: u32,
        /// Counted from 1.
        pub(super) index: u32,
    }
}

layout! {
    /// What is summed up over the groups.
    #[derive(Clone, Copy, Debug)]
    pub(super) struct Summands {
        pub(super) groups: u32,
        /// Which of the totals this is.
        pub(super) place: u32,
    }
}

layout! {
    /// What `couple::saturation` needs to know of a node.
    #[derive(Clone, Copy, Debug)]
    pub(super) struct NodeTraits {
        pub(super) sponge: u32,
        /// Suction of the node over that of its sponge, 0 at the surface.
        pub(super) suction: f32,
        /// Sum of the smoothing function over the nodes at rest.
        pub(super) interior: f32,
    }
}

/// First tet or node and number of them of every batch, and the sponge of every tet.
pub(super) fn batches(topology: &Topology) -> ([Batch; BATCHES], Vec<u32>) {
    let mut sponges = vec![0; topology.tets.len()];
    let mut batches = [Batch::default(); BATCHES];
    for (color, chunks) in batches.iter_mut().zip(&topology.chunks) {
        let first = chunks.iter().map(|chunk| chunk.tets.start).min().unwrap_or(0);
        let end = chunks.iter().map(|chunk| chunk.tets.end).max().unwrap_or(0);
        *color = Batch { first, count: end - first };
        for chunk in chunks {
            sponges[chunk.tets.start as usize..chunk.tets.end as usize].fill(chunk.sponge);
        }
    }
    for (color, batch) in batches[COLORS..].iter_mut().enumerate() {
        let [first, end] = [topology.vertex_color_start[color], topology.vertex_color_start[color + 1]];
        *batch = Batch { first, count: end - first };
    }
    (batches, sponges)
}

pub(super) fn batch_words(batches: &[Batch; BATCHES]) -> Vec<u32> {
    let padded = |batch: &Batch| {
        let mut words = batch.words();
        words.resize((BATCH_STRIDE / WORD_BYTES) as usize, 0);
        words
    };
    batches.iter().flat_map(padded).collect()
}
