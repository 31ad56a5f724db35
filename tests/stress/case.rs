//! A case: a scene, its duration, and its checks.

use std::{
    collections::BTreeMap,
    panic::{AssertUnwindSafe, catch_unwind},
};

use sorb::{World, scene::Scene};

use crate::{common, energy::Budget};

/// Time between two checks of a state \[s\].
const LOOK: f64 = 1.0 / 60.0;

/// Largest number of steps of a case: one that needs more is stuck.
const MAXIMUM_STEPS: u64 = 400_000;

/// A check of a case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Check {
    /// Nothing panics.
    Panic,
    /// The world can be built.
    Built,
    /// No step is refused.
    Step,
    /// No more steps than [`MAXIMUM_STEPS`].
    Effort,
    /// Everything is finite and in the box, and no particle is lost.
    Healthy,
    /// The mass of the water is the same to the bit.
    Mass,
    /// Nothing is faster than the case allows.
    Speed,
    /// The energy is within the budget.
    Energy,
    /// The sponge is back to 95 % of its volume in time.
    Recovery,
    /// The figure of the case is within its bound.
    Figure,
}

/// A measure of the final state, and its largest value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Figure {
    pub(crate) name: &'static str,
    pub(crate) of: fn(&World) -> f64,
    pub(crate) maximum: f64,
}

/// A case with its bounds.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: String,
    pub(crate) scene: Scene,
    /// Time to run \[s\].
    pub(crate) seconds: f64,
    /// Largest speed of particles and nodes \[m/s\].
    pub(crate) fastest: f64,
    /// Energy gained, over the energy put in; `None` where work is done that is not counted.
    pub(crate) excess: Option<f64>,
    /// Time at which a sponge is released, and time that it has to recover \[s\].
    pub(crate) recovery: Option<(f64, f64)>,
    pub(crate) figure: Option<Figure>,
    /// Known faults of the simulator, with the cause. A case fails if one of them is gone.
    pub(crate) known: &'static [(Check, &'static str)],
}

impl Case {
    /// A case with 3 m/s, twice the speed of a fall through the box, and a gain of a twentieth of its energy.
    pub(crate) fn new(name: impl Into<String>, scene: Scene, seconds: f64) -> Self {
        Self {
            name: name.into(),
            scene,
            seconds,
            fastest: 3.0,
            excess: Some(0.05),
            recovery: None,
            figure: None,
            known: &[],
        }
    }
}

/// Result of a case.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    /// Checks that failed, with the figures.
    pub(crate) broken: BTreeMap<Check, String>,
    steps: u64,
    time: f64,
    fastest: f64,
    /// Whether that was a node.
    is_node: bool,
    excess: f64,
    recovered: Option<f64>,
    figure: Option<f64>,
}

impl Outcome {
    fn breaks(&mut self, check: Check, what: impl Into<String>) {
        self.broken.entry(check).or_insert_with(|| what.into());
    }

    /// A row of the table in the documentation.
    fn row(&self, case: &Case) -> String {
        let optional =
            |value: Option<f64>, unit: &str| value.map_or("-".to_owned(), |v| format!("{v:.3}{unit}"));
        let excess = case.excess.map(|_| 100.0 * self.excess);
        let figure = case.figure.map_or_else(String::new, |figure| format!("{} ", figure.name));
        let broken: Vec<_> = self.broken.iter().map(|(check, what)| format!("{check:?}: {what}")).collect();
        format!(
            "| {} | {:.2} s | {} | {:.2} m/s ({}) | {} | {} | {figure}{} | {} |",
            case.name,
            self.time,
            self.steps,
            self.fastest,
            if self.is_node { "node" } else { "particle" },
            optional(excess, " %"),
            optional(self.recovered, " s"),
            optional(self.figure, ""),
            if broken.is_empty() { "ok".to_owned() } else { broken.join("; ") },
        )
    }
}

/// Runs a case, whatever happens.
pub(crate) fn outcome(case: &Case) -> Outcome {
    let mut outcome = Outcome::default();
    match catch_unwind(AssertUnwindSafe(|| run(case, &mut outcome))) {
        Ok(Ok(())) => {}
        Ok(Err((check, what))) => outcome.breaks(check, what),
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            outcome.breaks(Check::Panic, text.unwrap_or_default());
        }
    }
    outcome
}

fn run(case: &Case, outcome: &mut Outcome) -> Result<(), (Check, String)> {
    let mut world = World::new(&case.scene).map_err(|error| (Check::Built, error.to_string()))?;
    let (particles, mass) = (world.particle_ids().len(), world.measures().water_mass);
    let mut budget = Budget::of(&world);
    let mut next = 0.0;
    outcome.excess = f64::NEG_INFINITY;
    while world.clock().time < case.seconds {
        let report = world.step().map_err(|error| (Check::Step, error.to_string()))?;
        budget.add_step(&world);
        outcome.steps = world.clock().steps;
        outcome.time = report.time;
        if f64::from(report.maximum_speed) > outcome.fastest {
            outcome.fastest = f64::from(report.maximum_speed);
            outcome.is_node = fastest(world.node_velocities()) >= fastest(world.particle_velocities());
        }
        if outcome.steps > MAXIMUM_STEPS {
            return Err((Check::Effort, format!("{} steps of {:e} s", outcome.steps, report.step)));
        }
        if report.time < next && report.time < case.seconds {
            continue;
        }
        next = report.time + LOOK;
        if let Some(what) = common::unhealthy(&world, particles) {
            return Err((Check::Healthy, format!("at {:.3} s: {what}", report.time)));
        }
        if world.measures().water_mass.to_bits() != mass.to_bits() {
            outcome.breaks(Check::Mass, format!("{mass} kg, then {} kg", world.measures().water_mass));
        }
        outcome.excess = crate::energy::largest([outcome.excess, budget.excess(&world)]);
        if let Some((released, _)) = case.recovery
            && report.time >= released
        {
            recover(&world, report.time - released, &mut outcome.recovered);
        }
    }
    judge(case, &world, outcome);
    Ok(())
}

fn fastest(velocities: &[[f32; 4]]) -> f32 {
    velocities.iter().map(|v| v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).fold(0.0, f32::max)
}

/// Records since when the volume is back to 95 %.
fn recover(world: &World, time: f64, recovered: &mut Option<f64>) {
    let rest = world.lattice().rest_volume(0).unwrap_or(f64::NAN);
    let is_back = world.measures().sponge_volume / rest >= 0.95;
    *recovered = if is_back { recovered.or(Some(time)) } else { None };
}

/// NaN is out of every bound.
fn within(value: f64, bound: f64) -> bool {
    value <= bound
}

/// Compares the figures of a completed run with their bounds.
fn judge(case: &Case, world: &World, outcome: &mut Outcome) {
    if !within(outcome.fastest, case.fastest) {
        outcome.breaks(Check::Speed, format!("{:.2} m/s, bound {}", outcome.fastest, case.fastest));
    }
    if let Some(bound) = case.excess
        && !within(outcome.excess, bound)
    {
        outcome.breaks(Check::Energy, format!("{:.1} % more than was put in", 100.0 * outcome.excess));
    }
    if let Some((_, within)) = case.recovery
        && !outcome.recovered.is_some_and(|time| time <= within)
    {
        let ratio = world.measures().sponge_volume / world.lattice().rest_volume(0).unwrap_or(f64::NAN);
        let when = outcome.recovered.map_or("never".to_owned(), |time| format!("after {time:.2} s"));
        outcome.breaks(Check::Recovery, format!("{when}, bound {within} s; volume {ratio:.3} in the end"));
    }
    if let Some(figure) = case.figure {
        let value = (figure.of)(world);
        outcome.figure = Some(value);
        if !within(value, figure.maximum) {
            outcome.breaks(Check::Figure, format!("{} {value:.3}, bound {}", figure.name, figure.maximum));
        }
    }
}

/// Differences from the expectation: failed and not known, or known and not failed.
fn surprises(case: &Case, outcome: &Outcome) -> Vec<String> {
    let known = |check: &Check| case.known.iter().any(|(known, _)| known == check);
    let broken = outcome.broken.iter().filter(|(check, _)| !known(check));
    let broken = broken.map(|(check, what)| format!("{}: {check:?}: {what}", case.name));
    let mended = case.known.iter().filter(|(check, _)| !outcome.broken.contains_key(check));
    let mended = mended.map(|(check, cause)| {
        format!("{}: {check:?} holds now: take its expectation out ({cause})", case.name)
    });
    broken.chain(mended).collect()
}

/// Runs a table of cases, prints its rows, and fails if one differs from its expectation.
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
pub(crate) fn table(cases: impl IntoIterator<Item = Case>) {
    let mut all = Vec::new();
    for case in cases {
        let start = std::time::Instant::now();
        let outcome = outcome(&case);
        println!("{} {:.1} s real", outcome.row(&case), start.elapsed().as_secs_f64());
        all.extend(surprises(&case, &outcome));
    }
    assert!(all.is_empty(), "not as expected:\n  {}", all.join("\n  "));
}

/// Negative controls: every check can fail, and a listed fault that is gone is reported.
mod controls {
    use sorb::{glam::Vec3, scene::Domain};

    use super::*;
    use crate::scenes::{dry, wet, with_ball};

    fn breaks(case: &Case) -> Vec<Check> {
        outcome(case).broken.into_keys().collect()
    }

    #[test]
    fn every_bound_can_be_missed() {
        let good = Case::new("control", with_ball(dry(), 500.0, 1.0), 0.05);
        assert_eq!(breaks(&good), []);
        assert_eq!(breaks(&Case { fastest: 0.5, ..good.clone() }), [Check::Speed]);
        assert_eq!(breaks(&Case { excess: Some(-1.0), ..good.clone() }), [Check::Energy]);
        assert_eq!(breaks(&Case { excess: Some(f64::NAN), ..good.clone() }), [Check::Energy]);
        let figure = Figure { name: "nothing", of: |_| f64::NAN, maximum: 1.0 };
        assert_eq!(breaks(&Case { figure: Some(figure), ..good.clone() }), [Check::Figure]);
        assert_eq!(breaks(&Case { recovery: Some((1.0, 1.0)), ..good.clone() }), [Check::Recovery]);
        let mut refused = good.clone();
        (refused.scene.time.minimum_step, refused.scene.sponges[0].velocity) = (0.004, Vec3::X * 50.0);
        assert_eq!(breaks(&refused), [Check::Step]);
        let mut bad = good;
        bad.scene.sponges[0].porosity = 2.0;
        assert_eq!(breaks(&bad), [Check::Built]);
    }

    #[test]
    fn what_is_known_must_be_there() {
        let good = Case::new("control", dry(), 0.02);
        assert!(surprises(&good, &outcome(&good)).is_empty());
        let listed = Case { known: &[(Check::Speed, "none")], ..good.clone() };
        assert_eq!(surprises(&listed, &outcome(&listed)).len(), 1);
        let there = Case { fastest: -1.0, ..listed };
        assert!(surprises(&there, &outcome(&there)).is_empty());
    }

    #[test]
    fn what_is_lost_or_outside_is_seen() {
        let world = World::new(&wet()).unwrap_or_else(|error| panic!("{error}"));
        let (particles, domain) = (world.particle_ids().len(), world.scene().domain);
        assert_eq!(common::unhealthy_in(&world, domain, particles), None);
        assert!(common::unhealthy_in(&world, domain, particles + 1).is_some());
        let half = Domain::Box {
            minimum: Vec3::new(-1.0, 0.0, -1.0),
            maximum: Vec3::new(0.0, 1.0, 1.0),
            periodic: [false; 3],
        };
        assert!(common::unhealthy_in(&world, half, particles).is_some());
    }
}
