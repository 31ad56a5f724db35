//! Makes facts of a world.

use std::{
    collections::VecDeque,
    time::{Duration, Instant},
};

use sorb::{
    World,
    internal::{Place, Verdict},
};

use crate::{facts::Facts, orbit::Orbit};

/// Real time over which rates are taken.
const WINDOW: Duration = Duration::from_secs(1);

/// Points of a plot.
const POINTS: usize = 1200;

/// Makes facts of a world from frame to frame.
#[derive(Debug, Default)]
pub(crate) struct FactsBuilder {
    /// Real and simulated times of the last second \[s\].
    recent: VecDeque<(Instant, f64)>,
    /// Total times of the phases when the rates were made last, with the frames since then and their time.
    phases: Vec<(&'static str, f64)>,
    frames: u32,
    busy: Duration,
    made: Option<Instant>,
}

impl FactsBuilder {
    /// What does not change from frame to frame.
    pub(crate) fn scene(&mut self, world: &World, facts: &mut Facts) {
        let scene = world.scene();
        facts.name.clone_from(&scene.name);
        facts.title.clone_from(&scene.title);
        facts.camera = Some(Orbit::new(scene));
        facts.frame_rate = scene.time.frame_rate;
        facts.sponges = scene.sponges.iter().map(|sponge| sponge.name.clone()).collect();
        let plan = world.plan();
        let why = |verdict: &Verdict| match verdict {
            Verdict::Runs => None,
            Verdict::Skipped(why) => Some(*why),
        };
        facts.skipped =
            plan.lines().iter().filter_map(|line| Some((line.name, why(&line.verdict)?))).collect();
        let on_gpu = plan.lines().iter().any(|line| matches!(plan.place(line.name), Place::Gpu));
        let cpu = world.cpu();
        let place = if on_gpu { "GPU" } else { "CPU" };
        let threads = if cpu.threads() == 1 { "thread" } else { "threads" };
        facts.machine = format!("{place}, {} {threads}, {}", cpu.threads(), cpu.simd().name());
    }

    /// The simulation waits: rates begin anew.
    pub(crate) fn pause(&mut self) {
        self.recent.clear();
    }

    /// After a frame, which took so long.
    pub(crate) fn frame(&mut self, world: &World, took: Duration, facts: &mut Facts) {
        let now = Instant::now();
        self.recent.push_back((now, world.clock().time));
        while self.recent.front().is_some_and(|(then, _)| now.duration_since(*then) > WINDOW) {
            self.recent.pop_front();
        }
        self.frames += 1;
        self.busy += took;
        let is_due = self.made.is_none_or(|made| now.duration_since(made) > WINDOW / 2);
        if is_due {
            self.rates(world, facts);
            self.made = Some(now);
        }
        let saturations = saturations(world);
        if !saturations.is_empty() {
            facts.saturations.push((world.clock().time, saturations));
        }
        // Every other point goes where there are too many.
        if facts.saturations.len() > POINTS {
            let mut keeps = false;
            facts.saturations.retain(|_| {
                keeps = !keeps;
                keeps
            });
        }
    }

    /// Clock and counts.
    pub(crate) fn clock(&self, world: &World, facts: &mut Facts) {
        let (clock, ledger) = (world.clock(), world.ledger());
        (facts.time, facts.frames, facts.steps) = (clock.time, clock.frames, clock.steps);
        facts.particles = (ledger.present, ledger.absorbed);
        facts.ratio = self.recent.front().zip(self.recent.back()).and_then(|((then, from), (now, to))| {
            let real = now.duration_since(*then).as_secs_f64();
            (facts.runs && real > 0.2).then(|| (to - from) / real)
        });
    }

    /// Times of the phases in a frame since they were made last.
    fn rates(&mut self, world: &World, facts: &mut Facts) {
        let frames = f64::from(std::mem::take(&mut self.frames).max(1));
        facts.frame_ms = std::mem::take(&mut self.busy).as_secs_f64() * 1e3 / frames;
        let totals: Vec<(&'static str, f64)> =
            world.phase_times().iter().map(|phase| (phase.name, phase.total_s)).collect();
        let before =
            |name: &str| self.phases.iter().find(|(own, _)| *own == name).map_or(0.0, |(_, total)| *total);
        facts.phases = totals
            .iter()
            .map(|(name, total)| (*name, (total - before(name)).max(0.0) * 1e3 / frames))
            .filter(|(_, time)| *time > 0.0)
            .collect();
        facts.phases.sort_by(|a, b| b.1.total_cmp(&a.1));
        self.phases = totals;
    }
}

/// Mean saturation of every sponge; empty without water.
fn saturations(world: &World) -> Vec<f32> {
    let (nodes, lattice) = (world.node_saturations(), world.lattice());
    if nodes.is_empty() {
        return Vec::new();
    }
    let mut sums = vec![[0.0_f64; 2]; lattice.sponges.len()];
    let rows = nodes.iter().zip(&lattice.node_volume).zip(&lattice.node_sponge);
    for ((saturation, volume), sponge) in rows {
        let (saturation, volume) = (f64::from(saturation.min(1.0)), f64::from(*volume));
        if let Some(sum) = sums.get_mut(*sponge as usize) {
            *sum = [sum[0] + volume * saturation, sum[1] + volume];
        }
    }
    sums.into_iter().map(|[sum, volume]| (sum / volume.max(1e-30)) as f32).collect()
}
