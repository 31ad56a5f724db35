//! Bodies that are light compared with what they displace.
//!
//! The pressure solve and the contact of sponges take the motion of bodies in a step as prescribed. Bodies receive the
//! impulses afterwards. A body much lighter than what it displaces would overshoot, and overshoot back in the next step
//! (added-mass instability). In reality it accelerates a part of the fluid, for a ball half of what it displaces (its added
//! mass). A body in contact therefore has at least a quarter of the inertia of what it displaces:
//!
//! ```text
//! m* dv = J + m g h,   m* = max(m, rho_0 V / 4)
//! ```
//!
//! The pressure solve of `divergence` knows the masses of bodies. With it a body in contact with fluid alone keeps its inertia.
//!
//! J is the impulse of the step. Weight and draft are unchanged. The fluid adds the added mass. A ball without mass that is
//! released under water starts a third too slowly, one of a tenth of the density a fifth. From a quarter of the density on
//! nothing changes. With less than a quarter the ball still gains energy (docs/pressure-solve.md, docs/history.md).

use glam::{DVec3, Vec3};

use super::{BodyKind, RigidEngine, Wrench};
use crate::scene::{FluidSolver, Scene};

/// Smallest inertia of a body in contact, over that of what it displaces.
const MINIMUM_INERTIA: f64 = 0.25;

/// Inertia factors of light bodies.
#[derive(Clone, Debug)]
pub(crate) struct LightBodies {
    /// m / m* of every body.
    shares: Vec<Shares>,
    gravity: DVec3,
}

/// m / m* of a body by what it touches.
#[derive(Clone, Copy, Debug)]
struct Shares {
    fluid: f64,
    nodes: f64,
    both: f64,
}

impl LightBodies {
    pub(crate) fn new(scene: &Scene) -> Self {
        let fluid = scene.fluid.as_ref().map_or(0.0, |fluid| fluid.rest_density);
        let present = scene.sponges.iter().filter(|sponge| !sponge.is_removed());
        let sponge = present.map(|sponge| sponge.density).fold(0.0, f32::max);
        let is_solved = scene.fluid_solver() == Some(FluidSolver::Divergence);
        let shares = scene.bodies.iter().map(|body| {
            let share =
                |displaced| if body.kind == BodyKind::Dynamic { share(body.density, displaced) } else { 1.0 };
            let both = share(fluid.max(sponge));
            Shares { fluid: if is_solved { 1.0 } else { both }, nodes: share(sponge), both }
        });
        Self { shares: shares.collect(), gravity: scene.gravity.as_dvec3() }
    }

    /// Sets the acceleration of gravity \[m/s^2\].
    pub(crate) fn set_gravity(&mut self, gravity: Vec3) {
        self.gravity = gravity.as_dvec3();
    }

    /// The acceleration of gravity \[m/s^2\].
    pub(crate) fn gravity(&self) -> Vec3 {
        self.gravity.as_vec3()
    }

    /// Wrenches for the engine, from those that fluid and nodes gave the bodies in a step \[s\].
    pub(crate) fn wrenches(
        &self,
        engine: &dyn RigidEngine,
        given: &[(Wrench, Wrench)],
        step: f32,
    ) -> Vec<Wrench> {
        let wrench = |(index, (fluid, nodes)): (usize, &(Wrench, Wrench))| {
            let impulse = fluid.impulse + nodes.impulse;
            let angular_impulse = fluid.angular_impulse + nodes.angular_impulse;
            let touches = (fluid.impulse != DVec3::ZERO, nodes.impulse != DVec3::ZERO);
            let share = self.shares.get(index).map_or(1.0, |shares| match touches {
                (true, true) => shares.both,
                (true, false) => shares.fluid,
                (false, true) => shares.nodes,
                (false, false) => 1.0,
            });
            let inverse_mass = f64::from(engine.inverse_mass(index));
            if share == 1.0 || inverse_mass == 0.0 {
                return Wrench { impulse, angular_impulse };
            }
            // The engine adds the whole weight, but a body with more inertia takes only a share of its acceleration.
            let weight = self.gravity * (f64::from(step) / inverse_mass);
            Wrench {
                impulse: impulse * share - weight * (1.0 - share),
                angular_impulse: angular_impulse * share,
            }
        };
        given.iter().enumerate().map(wrench).collect()
    }
}

/// m / m*.
fn share(density: f32, displaced: f32) -> f64 {
    let minimum = MINIMUM_INERTIA * f64::from(displaced);
    if f64::from(density) < minimum { f64::from(density) / minimum } else { 1.0 }
}

#[cfg(all(test, feature = "rigid"))]
mod tests {
    use super::*;
    use crate::{
        rigid::{BodySetup, RapierEngine},
        scene::{Body, Fluid, ShapeKind, Sponge},
    };

    const STEP: f32 = 0.002;
    const GRAVITY: f32 = 9.81;

    /// Velocity along y of a ball of some density after a step with the given impulses, which are over its weight in the
    /// step.
    fn after_a_step(density: f32, by_fluid: f64, by_nodes: f64) -> f32 {
        after_a_step_with(FluidSolver::Dfsph, density, by_fluid, by_nodes)
    }

    fn after_a_step_with(solver: FluidSolver, density: f32, by_fluid: f64, by_nodes: f64) -> f32 {
        let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.05 }, Vec3::ZERO, density);
        let sponge = Sponge { density: 100.0, ..Sponge::default() };
        let scene = Scene::new("light")
            .with_fluid(Fluid { solver: Some(solver), ..Fluid::default() })
            .with_sponge(sponge)
            .with_body(ball);
        let setup = BodySetup {
            name: "ball".to_owned(),
            shape: crate::rigid::Shape::Sphere { radius: 0.05 },
            kind: BodyKind::Dynamic,
            density,
            state: scene.bodies[0].start(),
            friction: 0.0,
            restitution: 0.0,
            motions: Vec::new(),
        };
        let gravity = Vec3::new(0.0, -GRAVITY, 0.0);
        let mut engine = RapierEngine::new(gravity, None, &[setup]).unwrap_or_else(|error| panic!("{error}"));
        let mass = 1.0 / f64::from(engine.inverse_mass(0));
        let weight = mass * f64::from(GRAVITY * STEP);
        let up = |over: f64| Wrench { impulse: DVec3::Y * over * weight, angular_impulse: DVec3::ZERO };
        let light = LightBodies::new(&Scene { gravity, ..scene });
        let wrenches = light.wrenches(&engine, &[(up(by_fluid), up(by_nodes))], STEP);
        engine.step(STEP, &wrenches).unwrap_or_else(|error| panic!("{error}"));
        engine.state(0).linear_velocity.y
    }

    #[test]
    fn a_light_body_has_its_own_weight_and_more_inertia() {
        let fall = GRAVITY * STEP;
        let is =
            |found: f32, expected: f32| assert!((found - expected).abs() < 1e-4 * fall, "{found} {expected}");
        // At a hundredth of the density of water: supported by its weight, it rests. In the air it falls like any body.
        is(after_a_step(10.0, 1.0, 0.0), 0.0);
        is(after_a_step(10.0, 0.0, 0.0), -fall);
        // Pushed harder, it responds as a body of 250 kg/m^3.
        is(after_a_step(10.0, 11.0, 0.0), 0.4 * fall);
        // Under a sponge of 100 kg/m^3, as one of 25.
        is(after_a_step(10.0, 0.0, 11.0), 4.0 * fall);
        is(after_a_step(1.0, 0.0, 11.0), 0.4 * fall);
        // Negative control: from a quarter of the density on nothing changes.
        is(after_a_step(250.0, 11.0, 0.0), 10.0 * fall);
        is(after_a_step(25.0, 0.0, 11.0), 10.0 * fall);
    }

    #[test]
    fn a_solve_that_knows_the_mass_of_a_body_leaves_its_inertia() {
        let fall = GRAVITY * STEP;
        let solved =
            |by_fluid, by_nodes| after_a_step_with(FluidSolver::Divergence, 10.0, by_fluid, by_nodes);
        let is =
            |found: f32, expected: f32| assert!((found - expected).abs() < 1e-4 * fall, "{found} {expected}");
        is(solved(11.0, 0.0), 10.0 * fall);
        // The contact with nodes is outside of the solve: under a dry sponge it is as one of 25 kg/m^3, under a wet one of 250.
        is(solved(0.0, 11.0), 4.0 * fall);
        is(solved(1.0, 10.0), 0.4 * fall);
    }
}
