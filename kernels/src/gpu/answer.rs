//! What is said to the device before steps, and what it says after them: the clock of `layout.wgsl`.

use super::{pack::Capacities, program::REPETITIONS, transfer::vector};
use crate::body::Wrench;

/// Words of the clock.
pub(super) const CLOCK_WORDS: usize = 44;
/// Bytes that come back after steps, beside 64 a body.
pub const CLOCK_BYTES: u64 = CLOCK_WORDS as u64 * 4;
pub(super) const WRENCH_BYTES: u64 = 64;

/// What happened to the last step of a batch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// All that was asked for was done, or there is time left for more steps.
    Done,
    /// A particle's position or velocity is not finite; its row.
    Particle(u32),
    /// A node's velocity is not finite; its row.
    Node(u32),
    /// The next step would have to be this short \[s\], by the bound of this index.
    TooSmall(f32, u32),
}

/// Bounds of a step that a device can count.
pub const BOUNDS: usize = 12;

/// What the device says after a batch of steps.
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
    pub last_bound: u32,
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
    /// How many steps each bound limited.
    pub bounds: [u32; BOUNDS],
    /// What the last step gave to every body, by fluid and by sponges.
    pub wrenches: Vec<(Wrench, Wrench)>,
    /// Rounds of repetitions that end when they have converged, of all steps since the time was set.
    pub rounds: u32,
    /// Most rounds that each of them took in these steps, in their order.
    pub(super) most_rounds: [u32; REPETITIONS],
    /// The repetition, counted from 1, of which more rounds are needed than were handed in, and how many it had.
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

/// `clock.wgsl` has these numbers too.
const NOT_FINITE_PARTICLE: u32 = 1;
const NOT_FINITE_NODE: u32 = 2;
const TOO_SMALL: u32 = 3;
const LIST_FULL: u32 = 4;
const UNFINISHED: u32 = 5;

impl Answer {
    pub(super) fn new(clock: &[u32], wrenches: &[f32]) -> Self {
        let float = |word: usize| f32::from_bits(clock[word]);
        let wrench =
            |words: &[f32]| Wrench { impulse: vector(&words[..3]), angular_impulse: vector(&words[4..7]) };
        let (status, row) = (clock[3], clock[12]);
        Self {
            outcome: match status {
                NOT_FINITE_PARTICLE => Outcome::Particle(row),
                NOT_FINITE_NODE => Outcome::Node(row),
                TOO_SMALL => Outcome::TooSmall(float(18), clock[9]),
                _ => Outcome::Done,
            },
            steps: clock[8],
            left: float(4),
            last_step: float(16),
            last_bound: clock[17],
            shortest: float(10),
            maximum_speed: float(11),
            fluid_speed: float(5),
            fluid_acceleration: float(6),
            node_speed: float(7),
            fluid_pressure: float(40),
            bounds: std::array::from_fn(|bound| clock[20 + bound]),
            wrenches: wrenches
                .chunks_exact(16)
                .map(|body| (wrench(&body[..8]), wrench(&body[8..])))
                .collect(),
            rounds: clock[35],
            most_rounds: std::array::from_fn(|index| clock[36 + index]),
            unfinished: (status == UNFINISHED).then(|| (clock[34] as usize, clock[32])),
            longest: (status == LIST_FULL).then(|| [clock[13], clock[14], clock[15], clock[42]]),
        }
    }
}
