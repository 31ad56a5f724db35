//! Bounds of the step.

use std::f32::consts::PI;

pub use sorb_kernels::clock::Bound;
use sorb_kernels::{
    body::Body,
    clock::{
        ACCELERATION_COURANT, CUT_TOLERANCE, LATTICE_COURANT, PEAK_PRESSURE, PRESSURE_COURANT,
        SHORTEST_BY_BODY, StepLimits,
    },
    params::{Params, Solver},
};

use serde::{Deserialize, Serialize};

use crate::{rigid::RigidEngine, scene::Scene};

/// Part of the time in which an elastic wave crosses a cell that a step of `sbd` may take. The solver is stable beyond, but one sweep a
/// step is then far from converged. A ball that falls on a dry sponge gains energy, and turns tets inside out.
const STRAIN: f32 = 0.25;

/// The same of `xpbd_neo_hookean`: a cantilever without
/// damping then sags by what it should within two per cent (`tests/sponge.rs`).
const NEO_HOOKEAN: f32 = 0.25;

/// The same of `vbd`, which is stable at any step. Four sweeps then give the lowest frequency of a cantilever within two per
/// cent; at twice the step they need ten (docs/performance.md).
const DESCENT: f32 = 2.0;

/// The same in water, beside a solve for the divergence. There a sponge is twenty times as heavy, and its waves are four and a half times
/// as slow.
const WET_DESCENT: f32 = 9.0;

/// The same beside other solves: in longer steps `dfsph` gains energy.
const WET_DESCENT_BY_DENSITY: f32 = 4.0;

/// Time since the start, and what the last step found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Clock {
    /// Simulated time \[s\].
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// Frames completed by [`crate::World::advance_frame`].
    pub frames: u64,
    /// Largest speed of a particle after the last step \[m/s\].
    pub(crate) fluid_speed: f32,
    /// Largest acceleration of a particle in the last step \[m/s^2\].
    pub(crate) fluid_acceleration: f32,
    /// Root mean square of the kinematic pressure in the last step, with a pressure solve \[m^2/s^2\].
    pub(crate) fluid_pressure: f32,
    /// Largest speed of a node after the last step \[m/s\].
    pub(crate) node_speed: f32,
    /// Largest speed of the surface of a body \[m/s\].
    pub(crate) body_speed: f32,
}

/// Step over the time in which the shortest capillary wave turns. At twice that particles at the surface of a drop do not come
/// to rest.
const CAPILLARY_COURANT: f32 = 0.1;

/// Step of explicit viscosity over the time in which velocity diffuses over a support radius. On a lattice the sum over pairs is stable
/// below 0.097 of it with a support of 1.6 spacings. The bound is 0.078 with 2 and 0.073 with 3. Along the line between particles it is
/// 0.028 with any: `CENTRAL` is how much stiffer that form is taken to be.
const EXPLICIT: f32 = 0.0625;
const CENTRAL: f32 = 2.5;

/// Step of implicit over that of explicit viscosity, and the Courant number beside it. The pressure is solved after the
/// viscosity, as if particles could move without their neighbours. In longer steps a viscous fluid that falls on a floor
/// jumps to three times its initial height (docs/viscosity.md).
const IMPLICIT: f32 = 100.0;
const IMPLICIT_COURANT: f32 = 0.1;

/// Step over the time in which water under suction crosses a spacing, with a solve for the divergence. At 2 the water in a sponge that is
/// wrung is compressed by a seventh.
const SUCTION_COURANT: f32 = 1.2;

/// The same with other solves.
const SUCTION_COURANT_BY_DENSITY: f32 = 0.8;

/// Sleeping parts: steps leave them out, and they bound none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Dormant {
    pub(crate) fluid: bool,
    /// Numbers of sponges.
    pub(crate) sponges: Vec<usize>,
    /// Numbers of bodies.
    pub(crate) bodies: Vec<usize>,
}

/// Constant bounds of the step.
#[derive(Clone, Debug)]
pub(crate) struct Steps {
    limits: StepLimits,
}

impl Steps {
    pub(crate) fn new(
        scene: &Scene,
        params: &Params,
        bodies: &[Body],
        engine: &dyn RigidEngine,
        dormant: &Dormant,
    ) -> Self {
        let mut bounds = vec![(scene.time.maximum_step, Bound::Maximum)];
        let fluid = &params.fluid;
        let has_fluid = fluid.particle_mass > 0.0 && !dormant.fluid;
        let solves_divergence = fluid.divergence().is_some();
        let sponges = || params.sponges.iter().zip(&scene.sponges).enumerate();
        let is_out = |index: usize| dormant.sponges.contains(&index) || scene.sponges[index].is_removed();
        let sponges = || sponges().filter(|(index, _)| !is_out(*index)).map(|(_, own)| own);
        if let Some(water) = scene.fluid.as_ref().filter(|_| has_fluid) {
            let h = fluid.smoothing.support_radius;
            if let Some(implicit) = &fluid.implicit_viscosity {
                let viscosity = implicit.viscosity + implicit.central_viscosity + fluid.strain_viscosity;
                let explicit = EXPLICIT * h * h / (viscosity / fluid.rest_density);
                let stopped = bodies.iter().enumerate().filter(|(_, body)| body.no_slip);
                let longest = stopped.map(|(index, body)| stopping(params, body, engine, index));
                bounds.push((longest.fold(IMPLICIT * explicit, f32::min), Bound::Viscosity));
            } else {
                // The rate of strain counts twice. What the rotation takes from that bounds nothing.
                let viscosity =
                    fluid.viscosity + CENTRAL * fluid.central_viscosity + 2.0 * fluid.strain_viscosity;
                bounds.push((EXPLICIT * h * h / (viscosity / fluid.rest_density), Bound::Viscosity));
            }
            let capillary = fluid.rest_density * h * h * h / (2.0 * PI * water.surface_tension);
            bounds.push((CAPILLARY_COURANT * capillary.sqrt(), Bound::SurfaceTension));
            for (sponge, scene) in sponges() {
                if params.solid.is_some() {
                    // Water enters at this speed; nodes bear the suction together with the water that they hold.
                    let pressure = sponge.entry_pressure + sponge.wetting.receding;
                    let pressure = pressure * (1.0 + sponge.saturation_gain);
                    let speed = (2.0 * pressure / fluid.rest_density).sqrt();
                    let courant =
                        if solves_divergence { SUCTION_COURANT } else { SUCTION_COURANT_BY_DENSITY };
                    bounds.push((courant * fluid.spacing / speed, Bound::Suction));
                    continue;
                }
                // The springs of one node sum to 14 p V / H^2 where its support is full of water.
                let radius = params.coupling.support_radius;
                let pressure = sponge.entry_pressure * (1.0 + sponge.saturation_gain) * sponge.reaction;
                let frequency = (14.0 * pressure / (scene.density * radius * radius)).sqrt();
                bounds.push((1.0 / frequency, Bound::Suction));
            }
        }
        for (sponge, scene) in sponges() {
            let crossing = |modulus: f32| sponge.edge * (scene.density / modulus).sqrt();
            bounds.push(match sponge.solver {
                Solver::Sbd => {
                    let modulus = sponge.stretch_modulus.max(sponge.shear_modulus).max(sponge.volume_modulus);
                    (STRAIN * crossing(modulus), Bound::Elasticity)
                }
                Solver::XpbdNeoHookean => (NEO_HOOKEAN * crossing(scene.young_modulus), Bound::Elasticity),
                Solver::Vbd => {
                    let part = match params.solid {
                        Some(_) if solves_divergence => WET_DESCENT,
                        Some(_) => WET_DESCENT_BY_DENSITY,
                        None => DESCENT,
                    };
                    (part * crossing(scene.young_modulus), Bound::Elasticity)
                }
            });
        }
        let (constant, constant_bound) = smallest(&bounds);
        let edge = sponges().map(|(sponge, _)| sponge.edge).fold(f32::INFINITY, f32::min);
        let maximum = if fluid.implicit_viscosity.is_some() { IMPLICIT_COURANT } else { f32::INFINITY };
        let courant = scene.time.courant.min(maximum);
        let minimum = scene.time.minimum_step;
        Self { limits: StepLimits { courant, edge, has_fluid, minimum, constant, constant_bound } }
    }

    /// Longest stable step after the last one, and its bound.
    pub(crate) fn stable(&self, params: &Params, clock: &Clock) -> (f32, Bound) {
        let limits = &self.limits;
        let mut bounds = vec![(limits.constant, limits.constant_bound)];
        let fluid = &params.fluid;
        let h = fluid.smoothing.support_radius;
        if limits.has_fluid {
            let sound_speed = if fluid.incompressible.is_some() { 0.0 } else { fluid.sound_speed };
            bounds.push((limits.courant * h / (sound_speed + clock.fluid_speed), Bound::Courant));
            let pressure = PEAK_PRESSURE * clock.fluid_pressure;
            bounds.push((PRESSURE_COURANT * fluid.spacing / pressure.sqrt(), Bound::Pressure));
            // A solve for the divergence has no error that grows with the acceleration of a particle.
            if fluid.divergence().is_none() {
                let crossing = (h / clock.fluid_acceleration).sqrt();
                bounds.push((ACCELERATION_COURANT * crossing, Bound::Acceleration));
            }
        }
        bounds.push((LATTICE_COURANT * limits.edge / clock.node_speed, Bound::SpongeSpeed));
        let crossing = limits.reach_of_bodies(h) / clock.body_speed;
        bounds.push((crossing.max(SHORTEST_BY_BODY * limits.minimum), Bound::BodySpeed));
        smallest(&bounds)
    }

    /// The smallest of the bounds that do not change \[s\].
    pub(crate) fn constant(&self) -> (f32, Bound) {
        (self.limits.constant, self.limits.constant_bound)
    }

    /// The same bounds with another smallest one.
    #[cfg(feature = "serde")]
    #[must_use]
    pub(crate) fn with_constant(mut self, constant: f32, bound: Bound) -> Self {
        (self.limits.constant, self.limits.constant_bound) = (constant, bound);
        self
    }

    /// The part that does not change.
    #[cfg(feature = "gpu")]
    pub(crate) fn limits(&self) -> StepLimits {
        self.limits
    }

    /// Shortest step that is allowed \[s\].
    pub(crate) fn minimum(&self) -> f32 {
        self.limits.minimum
    }
}

/// Time in which a fluid stops a no-slip body, infinite for one that does not move freely.
///
/// The solve for the implicit viscosity prescribes the velocities of bodies, which receive its reaction afterwards: in
/// longer steps they would overshoot. The drag is that of Stokes on a sphere, with Basset's term for shear that has spread
/// over the time of a step only: `6 pi mu R (1 + R / sqrt(nu h))`, and `8 pi mu R^3 (1 + R / (3 sqrt(nu h)))` about its
/// centre.
fn stopping(params: &Params, body: &Body, engine: &dyn RigidEngine, index: usize) -> f32 {
    let fluid = &params.fluid;
    let (radius, viscosity) = (body.shape.bounding_radius(), fluid.wall_viscosity);
    // Root of R^2 / nu.
    let crossing = radius * (fluid.rest_density / viscosity).sqrt();
    let inertia = engine.inverse_inertia(index);
    let turning = inertia.x_axis.x.max(inertia.y_axis.y).max(inertia.z_axis.z);
    // h a + sqrt(h) b = 1.
    let time = |a: f32, b: f32| (2.0 / (b + (b * b + 4.0 * a).sqrt())).powi(2);
    let along = 6.0 * PI * viscosity * radius * engine.inverse_mass(index);
    let about = 8.0 * PI * viscosity * radius.powi(3) * turning;
    time(along, along * crossing).min(time(about, about * crossing / 3.0))
}

/// Shortens a step so that equal ones fill the rest of a frame: water at rest stays calmer than with a short last step.
pub(crate) fn within((step, bound): (f32, Bound), left: f64) -> (f32, Bound) {
    let whole = f64::from(step);
    if whole >= left {
        return (left as f32, Bound::Frame);
    }
    if !left.is_finite() {
        return (step, bound);
    }
    let count = (left / whole * (1.0 - CUT_TOLERANCE)).ceil();
    ((left / count) as f32, bound)
}

/// The smallest bound; NaN bounds nothing (a speed of zero over an acceleration of zero).
fn smallest(bounds: &[(f32, Bound)]) -> (f32, Bound) {
    let mut best = bounds[0];
    for bound in &bounds[1..] {
        if bound.0 < best.0 {
            best = *bound;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_filled_without_slivers() {
        let step = (0.4, Bound::Courant);
        assert_eq!(within(step, f64::INFINITY), step);
        assert_eq!(within(step, 1.2), step);
        assert_eq!(within(step, 1.0), (1.0 / 3.0, Bound::Courant));
        assert_eq!(within(step, 0.6), (0.3, Bound::Courant));
        assert_eq!(within(step, 0.4), (0.4, Bound::Frame));
        assert_eq!(within(step, 0.1), (0.1, Bound::Frame));
        // The rest is filled by the same number of steps, whatever the rounding.
        let mut left = 1.0 / 60.0;
        let mut steps = 0;
        while left > 1e-9 {
            left -= f64::from(within((0.003, Bound::Courant), left).0);
            steps += 1;
        }
        assert_eq!(steps, 6);
    }

    #[cfg(all(feature = "serde", feature = "rigid"))]
    #[test]
    fn bodies_bound_the_steps_of_implicit_viscosity() {
        let bound = |viscosity: &str, density: f32, keys: &[&str]| {
            let viscosity = format!("fluid.viscosity={viscosity}");
            let own = [viscosity.as_str(), "time.maximum_step=0.1", "fluid.artificial_viscosity=0"];
            let keys = [&own[..], keys].concat();
            let scene = crate::scene::preset("water").and_then(|scene| scene.with_overrides(keys));
            let scene = scene.unwrap_or_else(|error| panic!("{error}"));
            let shape = crate::scene::ShapeKind::Sphere { radius: 0.02 };
            let ball = crate::scene::Body::dynamic("ball", shape, glam::Vec3::Y * 0.1, density);
            let scene = scene.with_body(crate::scene::Body { no_slip: true, ..ball });
            let world = crate::World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
            (world.steps.limits.constant, world.steps.limits.constant_bound)
        };
        let implicit = ["fluid.viscosity_integration=\"implicit\""];
        // Stokes alone: the rotation of a sphere stops within m / (20 pi mu R).
        let (step, name) = bound("1000", 5000.0, &implicit);
        let expected = 5000.0 * 4.0 / 3.0 * 0.02_f32.powi(2) / (20.0 * 1000.0);
        assert!(name == Bound::Viscosity && step < expected && step > 0.5 * expected, "{step} {expected}");
        assert!(bound("1000", 500.0, &implicit).0 < 0.2 * step, "lighter");
        // A heavy ball stops later than a hundred times the bound of explicit viscosity.
        let explicit = bound("100", 5e4, &[]);
        let (long, name) = bound("100", 5e4, &implicit);
        assert!(explicit.1 == Bound::Viscosity && name == Bound::Viscosity);
        assert!((long / explicit.0 - IMPLICIT).abs() < 1e-3, "{long} {}", explicit.0);
        assert_ne!(bound("0.1", 5000.0, &implicit).1, Bound::Viscosity);
    }

    #[test]
    fn the_smallest_bound_wins_and_not_a_number_never_does() {
        let bounds = [(2.0, Bound::Maximum), (f32::NAN, Bound::Suction), (1.0, Bound::Courant)];
        assert_eq!(smallest(&bounds), (1.0, Bound::Courant));
        assert_eq!(smallest(&bounds[..2]), (2.0, Bound::Maximum));
    }
}
