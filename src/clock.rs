//! Bounds of the step.

use std::f32::consts::PI;

use sorb_kernels::{
    body::Body,
    params::{Params, Solver},
};

use crate::{
    rigid::RigidEngine,
    scene::{Scene, Time},
};

/// Longest step of `xpbd_neo_hookean`, over the time in which an elastic wave crosses a cell: a cantilever without damping
/// then sags correctly within two per cent (`tests/sponge.rs`).
const NEO_HOOKEAN: f32 = 0.25;

/// The same of `vbd`, which is stable at any step. Four sweeps then give the lowest frequency of a cantilever within two per
/// cent; at twice the step they need ten (docs/performance.md).
const DESCENT: f32 = 2.0;

/// The same in water, where a sponge is twenty times as heavy and its waves are four times as slow.
const WET_DESCENT: f32 = 4.0;

/// Shortest step by the speed of a body, over `time.minimum_step`.
const SHORTEST_BY_BODY: f32 = 10.0;

/// Bound that limited a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// `time.maximum_step`.
    Maximum,
    /// The end of the frame.
    Frame,
    /// Sound and flow cross a support radius \[M92\].
    Courant,
    /// Pressure moves a particle against its neighbours.
    Pressure,
    /// Acceleration over a support radius.
    Acceleration,
    /// Diffusion of velocity over a support radius. With implicit viscosity fifty times that, and the time in which the
    /// fluid stops a no-slip body.
    Viscosity,
    /// Capillary waves.
    SurfaceTension,
    /// Suction against the mass of a dry node.
    Suction,
    /// Elastic waves of a dry sponge cross a part of the lattice constant, which depends on the solver.
    Elasticity,
    /// Nodes cross a quarter of the lattice constant.
    SpongeSpeed,
    /// The surface of a body crosses the distance that fluid and nodes may.
    BodySpeed,
    /// None: the whole scene sleeps, see [`Time::sleep_after`].
    Asleep,
}

impl Bound {
    /// Name as it appears in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Maximum => "maximum_step",
            Self::Frame => "frame",
            Self::Courant => "courant",
            Self::Pressure => "pressure",
            Self::Acceleration => "acceleration",
            Self::Viscosity => "viscosity",
            Self::SurfaceTension => "surface_tension",
            Self::Suction => "suction",
            Self::Elasticity => "elasticity",
            Self::SpongeSpeed => "sponge_speed",
            Self::BodySpeed => "body_speed",
            Self::Asleep => "asleep",
        }
    }
}

/// Time since the start, and results of the last step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

/// Step over the time in which pressure moves a particle by a spacing. At twice that the lattice of a pool at rest buckles
/// (docs/pressure-solve.md).
pub(crate) const PRESSURE_COURANT: f32 = 0.4;

/// Step over the period of the shortest capillary wave. At twice that particles at the surface of a drop do not come to
/// rest.
const CAPILLARY_COURANT: f32 = 0.1;

/// Step of implicit over that of explicit viscosity, and the Courant number beside it. The pressure is solved after the
/// viscosity, as if particles could move without their neighbours. In longer steps a viscous fluid that falls on a floor
/// jumps to three times its initial height (docs/viscosity.md).
const IMPLICIT: f32 = 50.0;
const IMPLICIT_COURANT: f32 = 0.1;

/// Step over the time in which water under suction crosses a spacing.
const SUCTION_COURANT: f32 = 0.8;

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
    pub(crate) time: Time,
    pub(crate) constant: (f32, Bound),
    pub(crate) edge: f32,
    pub(crate) has_fluid: bool,
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
        let sponges = || params.sponges.iter().zip(&scene.sponges).enumerate();
        let sponges = || sponges().filter(|(index, _)| !dormant.sponges.contains(index)).map(|(_, own)| own);
        if let Some(water) = scene.fluid.as_ref().filter(|_| has_fluid) {
            let h = fluid.smoothing.support_radius;
            // Along the line between particles this form is five times as stiff as the other.
            let viscosity = (fluid.viscosity + 5.0 * fluid.central_viscosity) / fluid.rest_density;
            bounds.push((0.125 * h * h / viscosity, Bound::Viscosity));
            if let Some(implicit) = &fluid.implicit_viscosity {
                let viscosity = implicit.viscosity + implicit.central_viscosity;
                let explicit = 0.125 * h * h / (viscosity / fluid.rest_density);
                let stopped = bodies.iter().enumerate().filter(|(_, body)| body.no_slip);
                let longest = stopped.map(|(index, body)| stopping(params, body, engine, index));
                bounds.push((longest.fold(IMPLICIT * explicit, f32::min), Bound::Viscosity));
            }
            let capillary = fluid.rest_density * h * h * h / (2.0 * PI * water.surface_tension);
            bounds.push((CAPILLARY_COURANT * capillary.sqrt(), Bound::SurfaceTension));
            for (sponge, scene) in sponges() {
                if params.solid.is_some() {
                    // Water enters at this speed; nodes bear the suction together with the water that they hold.
                    let pressure = sponge.entry_pressure + sponge.wetting.receding;
                    let pressure = pressure * (1.0 + sponge.saturation_gain);
                    let speed = (2.0 * pressure / fluid.rest_density).sqrt();
                    bounds.push((SUCTION_COURANT * fluid.spacing / speed, Bound::Suction));
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
                // The solver is stable beyond that, but one sweep per step is then far from converged: a ball that falls on
                // a dry sponge gains energy, and inverts tets.
                Solver::Sbd => {
                    let modulus = sponge.stretch_modulus.max(sponge.shear_modulus).max(sponge.volume_modulus);
                    (0.25 * crossing(modulus), Bound::Elasticity)
                }
                Solver::XpbdNeoHookean => (NEO_HOOKEAN * crossing(scene.young_modulus), Bound::Elasticity),
                Solver::Vbd => {
                    let part = if params.solid.is_some() { WET_DESCENT } else { DESCENT };
                    (part * crossing(scene.young_modulus), Bound::Elasticity)
                }
            });
        }
        let constant = smallest(&bounds);
        let edge = sponges().map(|(sponge, _)| sponge.edge).fold(f32::INFINITY, f32::min);
        let mut time = scene.time;
        if fluid.implicit_viscosity.is_some() {
            time.courant = time.courant.min(IMPLICIT_COURANT);
        }
        Self { time, constant, edge, has_fluid }
    }

    /// Longest stable step after the last one, and its bound.
    pub(crate) fn stable(&self, params: &Params, clock: &Clock) -> (f32, Bound) {
        let mut bounds = vec![self.constant];
        let fluid = &params.fluid;
        let h = fluid.smoothing.support_radius;
        if self.has_fluid {
            let sound_speed = if fluid.incompressible.is_some() { 0.0 } else { fluid.sound_speed };
            bounds.push((self.time.courant * h / (sound_speed + clock.fluid_speed), Bound::Courant));
            // In a column at rest the largest pressure is the square root of three times the root mean square.
            let pressure = 3.0_f32.sqrt() * clock.fluid_pressure;
            bounds.push((PRESSURE_COURANT * fluid.spacing / pressure.sqrt(), Bound::Pressure));
            bounds.push((0.25 * (h / clock.fluid_acceleration).sqrt(), Bound::Acceleration));
        }
        bounds.push((0.25 * self.edge / clock.node_speed, Bound::SpongeSpeed));
        let reach = if self.has_fluid { self.time.courant * h } else { f32::INFINITY };
        let crossing = reach.min(0.25 * self.edge) / clock.body_speed;
        // A script may move a body at any speed; faster bodies are swept.
        bounds.push((crossing.max(SHORTEST_BY_BODY * self.time.minimum_step), Bound::BodySpeed));
        smallest(&bounds)
    }

    /// Shortest step that is allowed \[s\].
    pub(crate) fn minimum(&self) -> f32 {
        self.time.minimum_step
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
    // Rounding must not add another step.
    let count = (left / whole * (1.0 - 1e-4)).ceil();
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
            world.steps.constant
        };
        let implicit = ["fluid.viscosity_integration=\"implicit\""];
        // Stokes alone: the rotation of a sphere stops within m / (20 pi mu R).
        let (step, name) = bound("1000", 5000.0, &implicit);
        let expected = 5000.0 * 4.0 / 3.0 * 0.02_f32.powi(2) / (20.0 * 1000.0);
        assert!(name == Bound::Viscosity && step < expected && step > 0.5 * expected, "{step} {expected}");
        assert!(bound("1000", 500.0, &implicit).0 < 0.2 * step, "lighter");
        // A heavy ball stops later than fifty times the bound of explicit viscosity.
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
