//! The clock of the device: what the host writes before steps, and what it reads after them with the wrenches on bodies.

use super::{
    capacities::Capacities,
    groups::{WRENCH_FLOATS, WRENCH_ROWS, rows_bytes},
    layout::{Value, WORD_BYTES, place_of, zero},
    vectors::wrench,
};
use crate::{
    body::Wrench,
    clock::Bound,
    layout::{enumeration, layout},
};

/// Bytes that come back after steps, beside 64 a body.
pub const CLOCK_BYTES: u64 = Clock::BYTES;
/// Bytes of the wrenches of fluid and sponges on a body: one after the other.
pub(super) const WRENCH_BYTES: u64 = 2 * rows_bytes(WRENCH_ROWS);
/// Most repetitions of a step that end when they have converged: the clock counts the rounds of each.
pub(super) const REPETITIONS: usize = 4;
/// Bytes of the clock before the largest speed of a body's surface, which the host finds.
pub(super) const BODY_SPEED_AT: u64 = WORD_BYTES * place_of::<Clock>("body_speed") as u64;

/// How the last step of a batch ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All that was asked for was done, or there is time left for more steps.
    Done,
    /// A particle's position or velocity is not finite; its row.
    Particle(u32),
    /// A node's velocity is not finite; its row.
    Node(u32),
    /// The next step would have to be this short \[s\], by this bound.
    TooSmall(f32, Bound),
}

/// Clock and wrenches of the device after a batch of steps.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// What happened to the last step.
    pub outcome: Outcome,
    /// Steps since the time was set.
    pub steps: u32,
    /// Time left of what was set \[s\].
    pub left: f32,
    /// Length of the last step \[s\].
    pub last_step: f32,
    /// Bound that limited the last step.
    pub last_bound: Bound,
    /// Shortest step \[s\].
    pub shortest: f32,
    /// Largest speed of particles and nodes in these steps \[m/s\].
    pub maximum_speed: f32,
    /// Largest speed of a particle after the last step \[m/s\].
    pub fluid_speed: f32,
    /// Largest acceleration of a particle in the last step \[m/s^2\].
    pub fluid_acceleration: f32,
    /// Largest speed of a node after the last step \[m/s\].
    pub node_speed: f32,
    /// Root of the mean square of the pressure over rest density in the last step, where it is solved for \[m^2/s^2\].
    pub fluid_pressure: f32,
    /// How many steps each bound limited, in the order of [`Bound::ALL`].
    pub bounds: [u32; Bound::ALL.len()],
    /// What the last step gave to every body, by fluid and by sponges.
    pub wrenches: Vec<(Wrench, Wrench)>,
    /// Rounds of repetitions that end when they have converged, of all steps since the time was set.
    pub rounds: u32,
    /// Most rounds that each of them took in these steps, in their order.
    pub(super) maximum_rounds: [u32; REPETITIONS],
    /// The repetition, counted from 1, of which more rounds are needed than were submitted, and how many it had.
    pub(super) unfinished: Option<(usize, u32)>,
    /// Lengths of lists that did not fit.
    pub(super) longest: Option<Capacities>,
}

/// Time that steps are to fill, and what the step before found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// Time to fill \[s\]; `f32::MAX` for steps as long as stability allows.
    pub left: f32,
    /// Largest speed of a particle \[m/s\].
    pub fluid_speed: f32,
    /// Largest acceleration of a particle \[m/s^2\].
    pub fluid_acceleration: f32,
    /// Largest speed of a node \[m/s\].
    pub node_speed: f32,
    /// Root of the mean square of the pressure over rest density, where it is solved for \[m^2/s^2\].
    pub fluid_pressure: f32,
}

enumeration! {
    /// Why the device stopped.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum Status {
        /// The time that was asked for is filled, or so many steps taken.
        Done,
        /// A particle is not finite.
        NotFiniteParticle,
        /// A node is not finite.
        NotFiniteNode,
        /// The step would be too small.
        TooSmall,
        /// A list did not fit.
        ListFull,
        /// A repetition needs more rounds than were submitted.
        Unfinished,
    }
}

enumeration! {
    /// What kernels find over all rows: a word each of the buffer `extremes`.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum Extreme {
        /// Largest squared speed of a particle, as bits of f32, like the next two.
        FluidSpeed,
        /// Largest squared acceleration of a particle.
        FluidAcceleration,
        /// Largest squared speed of a node.
        NodeSpeed,
        /// `u32::MAX` less the first row of the particles that are not finite; 0 if there is none.
        FluidRow,
        /// The same of nodes.
        NodeRow,
        /// Longest of the lists fluid to fluid that did not fit; 0 if all do.
        Neighbors,
        /// Longest of the lists fluid to controls.
        Controls,
        /// Longest of the lists controls to fluid.
        ControlFluid,
        /// Longest of the lists of nodes that may touch.
        Pairs,
        /// Longest of the lists fluid to images.
        NearImages,
        /// Longest of the lists images to fluid.
        ImageParticles,
        /// Images, where there is no room for all.
        Images,
        /// Root of the mean square of the pressure, as bits of f32.
        Pressure,
    }
}

layout! {
    /// Time on the device: everything that a step needs to know, and what the host wants to know of the steps of a batch.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub(super) struct Clock {
        step: f32,
        inverse_step: f32,
        /// Without it nothing is to be done; every kernel returns at once.
        running: bool,
        /// Why nothing is to be done.
        status: Status,
        /// Time left of what was asked for.
        left: f32,
        fluid_speed: f32,
        fluid_acceleration: f32,
        node_speed: f32,
        steps: u32,
        bound: Bound,
        shortest: f32,
        maximum_speed: f32,
        /// A row that is not finite.
        failed_row: u32,
        last_step: f32,
        last_bound: Bound,
        /// The step that stability asks for, where it is too small.
        needed: f32,
        /// Longest lists that did not fit, in the order of [`List`](super::capacities::List).
        longest: Capacities,
        /// How many steps every bound limited, in the order of [`Bound::ALL`].
        bounds: [[u32; 4]; 3],
        /// Most rounds of a step in this batch, of each repetition.
        maximum_rounds: [u32; REPETITIONS],
        /// Rounds of the present repetition so far, see `rounds.wgsl`.
        rounds: u32,
        /// Whether it has converged; the rounds that are left return at once.
        is_converged: bool,
        /// The repetition, counted from 1, that needs more rounds than were submitted.
        unfinished: u32,
        /// Rounds of all steps since the time was set.
        all_rounds: u32,
        /// Root of the mean square of the pressure over rest density in the last step, where it is solved for.
        fluid_pressure: f32,
        /// Largest speed of a body's surface.
        body_speed: f32,
        /// Whether the host gave the step, and there is one.
        given: bool,
    }
}

impl Clock {
    /// Before the first of some steps.
    pub(super) fn before(start: &Start) -> Self {
        let Start { left, fluid_speed, fluid_acceleration, node_speed, fluid_pressure } = *start;
        let shortest = f32::MAX;
        Self { left, fluid_speed, fluid_acceleration, node_speed, fluid_pressure, shortest, ..zero() }
    }

    /// Of one step of this length, which the device does not choose.
    pub(super) fn of_step(step: f32) -> Self {
        Self { step, inverse_step: 1.0 / step, running: true, left: step, given: true, ..zero() }
    }
}

impl Answer {
    pub(super) fn new(clock: &Clock, wrenches: &[f32]) -> Self {
        let has_status = |status| clock.status == status;
        Self {
            outcome: match clock.status {
                Status::NotFiniteParticle => Outcome::Particle(clock.failed_row),
                Status::NotFiniteNode => Outcome::Node(clock.failed_row),
                Status::TooSmall => Outcome::TooSmall(clock.needed, clock.bound),
                Status::Done | Status::ListFull | Status::Unfinished => Outcome::Done,
            },
            steps: clock.steps,
            left: clock.left,
            last_step: clock.last_step,
            last_bound: clock.last_bound,
            shortest: clock.shortest,
            maximum_speed: clock.maximum_speed,
            fluid_speed: clock.fluid_speed,
            fluid_acceleration: clock.fluid_acceleration,
            node_speed: clock.node_speed,
            fluid_pressure: clock.fluid_pressure,
            bounds: std::array::from_fn(|bound| clock.bounds[bound / 4][bound % 4]),
            wrenches: wrenches
                .chunks_exact(2 * WRENCH_FLOATS)
                .map(|body| body.split_at(WRENCH_FLOATS))
                .map(|(by_fluid, by_sponges)| (wrench(by_fluid), wrench(by_sponges)))
                .collect(),
            rounds: clock.all_rounds,
            maximum_rounds: clock.maximum_rounds,
            unfinished: has_status(Status::Unfinished).then_some((clock.unfinished as usize, clock.rounds)),
            longest: has_status(Status::ListFull).then_some(clock.longest),
        }
    }
}
