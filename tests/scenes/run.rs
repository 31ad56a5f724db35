//! A run of a scene, frame by frame.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use sorb::{Measures, World, internal, scene::Scene};

use crate::common::{self, Claims};

/// One frame of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sample {
    pub(crate) measures: Measures,
    /// Height of the lowest node [m].
    pub(crate) lowest: f64,
    /// Mean distance from the plane z = 0 of the free particles in the air, 2 cm above the floor [m].
    pub(crate) spread: f64,
}

pub(crate) struct Run {
    name: String,
    pub(crate) height: f64,
    pub(crate) start: Measures,
    pub(crate) samples: Vec<Sample>,
    /// One line per second, the digest last.
    text: String,
    pub(crate) broken: Option<String>,
    /// Heights of the bodies in the end [m].
    pub(crate) bodies: Vec<f32>,
}

impl Run {
    /// Runs a scene for some seconds of simulated time.
    pub(crate) fn of(scene: &Scene, seconds: f64) -> Self {
        let mut world = common::world(scene);
        let particles = world.particle_ids().len();
        let mut run = Self {
            name: scene.name.clone(),
            height: scene.sponges.first().map_or(0.0, |sponge| f64::from(sponge.size().y)),
            start: world.measures(),
            samples: Vec::new(),
            text: format!(
                "{}\nparticles {particles}, nodes {}, tets {}\n",
                scene.title,
                world.node_positions().len(),
                world.lattice().tets.len()
            ),
            broken: common::unhealthy(&world, particles),
            bodies: Vec::new(),
        };
        let rate = f64::from(scene.time.frame_rate);
        for frame in 1..=(seconds * rate).round() as u64 {
            common::frame(&mut world);
            run.samples.push(Sample::of(&world));
            if run.broken.is_none() {
                let unhealthy = common::unhealthy(&world, particles);
                run.broken = unhealthy.map(|what| format!("frame {frame}: {what}"));
            }
            if frame % rate as u64 == 0 {
                run.text.push_str(&(common::line(&world) + "\n"));
            }
        }
        run.text.push_str(&format!("digest {:016x}", world.state_digest()));
        run.bodies = world.bodies().iter().map(|body| body.state.position.y).collect();
        run
    }

    /// The frame at a time [s].
    pub(crate) fn at(&self, time: f64) -> &Sample {
        let found = self.samples.iter().find(|sample| sample.measures.time > time - 1e-6);
        found.unwrap_or_else(|| panic!("{} has ended before {time} s", self.name))
    }

    /// Smallest and largest of a quantity between two times.
    pub(crate) fn range(&self, times: std::ops::Range<f64>, quantity: impl Fn(&Sample) -> f64) -> (f64, f64) {
        let within =
            |sample: &&Sample| sample.measures.time >= times.start && sample.measures.time <= times.end;
        let values = self.samples.iter().filter(within).map(quantity);
        values
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    }

    /// Mean of a quantity between two times.
    pub(crate) fn mean(&self, times: std::ops::Range<f64>, quantity: impl Fn(&Sample) -> f64) -> f64 {
        let within =
            |sample: &&Sample| sample.measures.time >= times.start && sample.measures.time <= times.end;
        let values: Vec<f64> = self.samples.iter().filter(within).map(quantity).collect();
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Conditions of every scene.
    pub(crate) fn claims(&self) -> Claims {
        let mut claims = Claims::default();
        claims.claim(self.broken.is_none(), format!("{}: {:?}", self.name, self.broken));
        let water = self.samples.iter().map(|sample| sample.measures.water_mass);
        claims
            .claim(water.into_iter().all(|mass| mass == self.start.water_mass), "the mass of water changes");
        // Free fall through the container and the fastest body reach 2 m/s; an unstable run has no bound. Spinning grips
        // throw single particles at up to three times their own speed (docs/stress.md).
        let (_, fastest) = self.range(0.0..f64::INFINITY, |sample| sample.measures.maximum_speed);
        claims.claim(fastest < 5.0, format!("something moves at {fastest:.1} m/s"));
        claims
    }

    /// Compares with the golden, and checks the claims in either case.
    pub(crate) fn finish(self, claims: Claims) {
        let golden =
            catch_unwind(AssertUnwindSafe(|| common::golden(&format!("scene_{}", self.name), &self.text)));
        claims.hold();
        if let Err(panic) = golden {
            resume_unwind(panic);
        }
    }
}

impl Sample {
    fn of(world: &World) -> Self {
        let lowest = world.node_positions().iter().map(|row| f64::from(row[1])).fold(f64::INFINITY, f64::min);
        let interior = &internal::columns(world).fluid.interior;
        let free = world.particle_positions().iter().zip(interior).filter(|(_, interior)| **interior < 0.5);
        let (mut sum, mut count) = (0.0, 0.0);
        for (row, _) in free {
            if row[1] > 0.02 {
                sum += f64::from(row[2]).abs();
                count += 1.0;
            }
        }
        let spread = if count > 0.0 { sum / count } else { 0.0 };
        Self { measures: world.measures(), lowest, spread }
    }
}
