//! `summary.json`, and the final report.

use std::fmt;

use serde::Serialize;
use sorb::{StepError, World, internal::Verdict};

use super::{Record, table::Named};

/// The run in one JSON object.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    scene: String,
    backend: &'static str,
    /// The requested backend, and the adapter or why there is none; none for a plain run on the CPU.
    backend_reason: Option<String>,
    threads: usize,
    simd: &'static str,
    /// Factor of `--resolution`.
    resolution: f32,
    frames: usize,
    steps: u64,
    simulated_s: f64,
    wall_s: f64,
    picture_s: f64,
    step_ms_median: f32,
    frame_ms_median: f64,
    particle_steps_per_s: f64,
    particles: usize,
    nodes: usize,
    tets: usize,
    phases: Vec<Phase>,
    measures: Named,
    digest: String,
    diverged: Option<String>,
}

/// A phase of the step, whether it ran or not.
#[derive(Debug, Serialize)]
struct Phase {
    name: &'static str,
    ms_median: f32,
    ms_total: f64,
    calls: u64,
    skipped: bool,
    why: Option<&'static str>,
}

impl Summary {
    pub(super) fn new(world: &World, record: &Record, resolution: f32, failure: Option<&StepError>) -> Self {
        let (clock, wall_s) = (world.clock(), record.wall.as_secs_f64());
        let particles = world.particle_positions().len();
        let placement = world.plan().placement();
        let particle_steps = particles as f64 * clock.steps as f64;
        Self {
            scene: world.scene().name.clone(),
            backend: if placement.is_some_and(|placement| !placement.on_gpu.is_empty()) {
                "gpu"
            } else {
                "cpu"
            },
            backend_reason: placement.map(|placement| format!("{}: {}", placement.offload, placement.reason)),
            threads: world.cpu().threads(),
            simd: world.cpu().simd().name(),
            resolution,
            frames: record.frames_ms.len(),
            steps: clock.steps,
            simulated_s: clock.time,
            wall_s,
            picture_s: record.picture.as_secs_f64(),
            step_ms_median: world.step_time().median_ms(),
            frame_ms_median: median(&record.frames_ms),
            particle_steps_per_s: if wall_s > 0.0 { particle_steps / wall_s } else { 0.0 },
            particles,
            nodes: world.node_positions().len(),
            tets: world.lattice().tet_count(),
            phases: phases(world),
            measures: Named(record.measures),
            digest: format!("{:016x}", world.digest()),
            diverged: failure.map(StepError::to_string),
        }
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let measures = &self.measures.0;
        writeln!(
            out,
            "{}: {:.3} s simulated in {:.2} s ({} frames, {} steps), pictures {:.2} s",
            self.scene, self.simulated_s, self.wall_s, self.frames, self.steps, self.picture_s
        )?;
        writeln!(
            out,
            "  {} particles, {} nodes, {} tets on {} threads, {}: {:.3} ms a step, {:.2} M particle-steps/s",
            self.particles,
            self.nodes,
            self.tets,
            self.threads,
            self.simd,
            self.step_ms_median,
            self.particle_steps_per_s * 1e-6
        )?;
        if self.particles > 0 {
            writeln!(
                out,
                "  {:.4} kg of {:.4} kg of water in sponges, saturation {:.3}",
                measures.absorbed_mass, measures.water_mass, measures.saturation
            )?;
        }
        writeln!(out, "  digest {}", self.digest)
    }
}

/// Every phase of the plan once. A phase in several places of the step is skipped if it is skipped in all of them.
fn phases(world: &World) -> Vec<Phase> {
    let mut phases: Vec<Phase> = Vec::new();
    for line in world.plan().lines() {
        let why = match line.verdict {
            Verdict::Runs => None,
            Verdict::Skipped(why) => Some(why),
        };
        if let Some(known) = phases.iter_mut().find(|phase| phase.name == line.name) {
            known.skipped &= why.is_some();
            known.why = known.why.filter(|_| known.skipped);
            continue;
        }
        let time = world.phase_times().iter().find(|time| time.name == line.name);
        phases.push(Phase {
            name: line.name,
            ms_median: time.map_or(0.0, |time| time.median_ms()),
            ms_total: time.map_or(0.0, |time| time.total_s * 1e3),
            calls: time.map_or(0, |time| time.calls),
            skipped: why.is_some(),
            why,
        });
    }
    phases
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}
