mod build;
mod copies;
mod replace;
mod saved;
mod shapes;

use super::script::Script;
use super::setup::{check_step, checked_state};
use super::{BodyKind, BodySetup, BodyState, RigidEngine, RigidError, Target, Wrench};
use build::{check_container, collision_shape, parameters, rapier_mass};
use glam::{Mat3, Vec3};
use rapier3d::prelude::{
    BroadPhaseBvh, CCDSolver, ColliderBuilder, ColliderSet, ImpulseJointSet, IntegrationParameters,
    IslandManager, MultibodyJointSet, NarrowPhase, PhysicsPipeline, Pose, Real, RigidBodyBuilder,
    RigidBodyHandle, RigidBodySet, RigidBodyType, SoftBodySet,
};
pub use shapes::shape_of;
use std::{any::Any, sync::Arc};

/// Largest number of rapier3d steps in one step.
const MAXIMUM_PASSES: f32 = 32.0;

/// Distance along its path in which a body looks for contacts \[m\], at most the path of one step.
///
/// The swept test of rapier3d ignores half-spaces: without this a ball of 60 m/s sank 0.5 m into the floor.
const LOOK_AHEAD: Real = 1e3;

/// Bodies moved by rapier3d: dynamic, fixed and kinematic.
///
/// One step is one rapier3d step of four solver sub-steps. In each of them a free body follows `v += g h; x += v h` with `h = dt / 4`.
/// Where a body would move by more than the thickness of the thinnest dynamic body, the step is divided. There are at most 32 equal
/// rapier3d steps. Fast bodies then stop at a wall instead of inside it.
///
/// Gyroscopic forces are on. Sleep and contact recycling of rapier3d are off. Speed and spin have no limit. Lengths are
/// scaled to the thinnest dynamic body, because the defaults of rapier3d (contacts predicted 2 cm ahead) suit bodies of a
/// metre.
pub struct RapierEngine {
    gravity: Vec3,
    container: Option<(Vec3, Vec3)>,
    /// The bodies as they were built.
    setups: Arc<Vec<BodySetup>>,
    names: Vec<String>,
    kinds: Vec<BodyKind>,
    handles: Vec<RigidBodyHandle>,
    /// For fixed and kinematic bodies.
    scripts: Vec<Option<Script>>,
    states: Vec<BodyState>,
    /// Velocity and angular velocity that a held body continues with.
    held: Vec<Option<[Vec3; 2]>>,
    time: f64,
    parameters: IntegrationParameters,
    islands: IslandManager,
    broad_phase: BroadPhaseBvh,
    narrow_phase: NarrowPhase,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    continuous: CCDSolver,
    pipeline: PhysicsPipeline,
}

impl RapierEngine {
    /// Builds the bodies, in the order given, at time zero, in `gravity` \[m/s²\].
    ///
    /// `container` holds the lowest and the highest corner \[m\] of a box with fixed walls around all bodies; an
    /// infinite bound leaves that side open. The walls have no friction or restitution of their own.
    ///
    /// # Errors
    /// A value out of its range, a key that does not fit the kind of the body, or an unusable hull. Also a container without interior, or a
    /// dynamic body that starts with its centre outside it.
    pub fn new(
        gravity: Vec3,
        container: Option<(Vec3, Vec3)>,
        bodies: &[BodySetup],
    ) -> Result<Self, RigidError> {
        if !gravity.is_finite() {
            return Err(RigidError::Gravity { value: gravity.to_string() });
        }
        if let Some(container) = container {
            check_container(container, bodies)?;
        }
        Self::build(gravity, container, bodies)
    }

    /// The same of a container that holds the bodies.
    fn build(
        gravity: Vec3,
        container: Option<(Vec3, Vec3)>,
        bodies: &[BodySetup],
    ) -> Result<Self, RigidError> {
        let mut engine = Self {
            gravity,
            container,
            setups: Arc::new(bodies.to_vec()),
            names: bodies.iter().map(|body| body.name.clone()).collect(),
            kinds: bodies.iter().map(|body| body.kind).collect(),
            handles: Vec::with_capacity(bodies.len()),
            scripts: Vec::with_capacity(bodies.len()),
            states: Vec::with_capacity(bodies.len()),
            held: vec![None; bodies.len()],
            time: 0.0,
            parameters: parameters(bodies),
            islands: IslandManager::new(),
            broad_phase: BroadPhaseBvh::new(),
            narrow_phase: NarrowPhase::new(),
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            continuous: CCDSolver::new(),
            pipeline: PhysicsPipeline::new(),
        };
        if let Some(container) = container {
            engine.add_walls(container);
        }
        for body in bodies {
            engine.add(body)?;
        }
        Ok(engine)
    }

    /// Time since the start \[s\].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.time
    }

    fn add(&mut self, body: &BodySetup) -> Result<(), RigidError> {
        let state = checked_state(body)?;
        let shape = collision_shape(body, &body.shape)?;
        let mass = rapier_mass(body)?;
        let builder = match body.kind {
            BodyKind::Dynamic => RigidBodyBuilder::dynamic()
                .linvel(state.linear_velocity)
                .angvel(state.angular_velocity)
                .gyroscopic_forces_enabled(true)
                // The default limits the spin, which would break the conservation of angular momentum.
                .allow_fast_rotation(true)
                .soft_ccd_prediction(LOOK_AHEAD)
                .ccd_enabled(true),
            BodyKind::Fixed => RigidBodyBuilder::fixed(),
            BodyKind::Kinematic => RigidBodyBuilder::kinematic_position_based(),
        };
        let script = match body.kind {
            BodyKind::Dynamic => None,
            BodyKind::Fixed | BodyKind::Kinematic => Some(Script::new(state, &body.motions)),
        };
        let state = script.as_ref().map_or(state, |script| script.state(0.0));
        let handle = self.bodies.insert(builder.pose(pose(&state)).can_sleep(false));
        let collider = ColliderBuilder::new(shape)
            .mass_properties(mass)
            .friction(body.friction)
            .restitution(body.restitution);
        self.colliders.insert_with_parent(collider, handle, &mut self.bodies);
        // The inverse inertia has to be right before the first step too.
        self.bodies[handle].recompute_mass_properties_from_colliders(&self.colliders);
        self.handles.push(handle);
        self.scripts.push(script);
        self.states.push(state);
        Ok(())
    }

    /// Refuses a wrench that would leave the range of `f32`, before anything has changed.
    fn check_velocities(&self, wrenches: &[Wrench]) -> Result<(), RigidError> {
        for (index, wrench) in wrenches.iter().enumerate() {
            let linear = wrench.impulse.as_vec3() * self.inverse_mass(index);
            let angular = self.inverse_inertia(index) * wrench.angular_impulse.as_vec3();
            let state = &self.states[index];
            for (quantity, velocity, value) in [
                ("impulse", state.linear_velocity + linear, wrench.impulse),
                ("angular_impulse", state.angular_velocity + angular, wrench.angular_impulse),
            ] {
                if !velocity.is_finite() {
                    let body = self.names[index].clone();
                    return Err(RigidError::Wrench { body, index, quantity, value: value.to_string() });
                }
            }
        }
        Ok(())
    }

    fn push(&mut self, wrenches: &[Wrench]) {
        for (&handle, wrench) in self.handles.iter().zip(wrenches) {
            let body = &mut self.bodies[handle];
            body.apply_impulse(wrench.impulse.as_vec3(), true);
            body.apply_torque_impulse(wrench.angular_impulse.as_vec3(), true);
        }
    }

    /// Number of rapier3d steps that keep every path below the thickness of the thinnest dynamic body.
    ///
    /// Contacts are predicted along the path, but a body that reaches several walls in one step needs more than one
    /// prediction.
    fn passes(&self, dt: f32) -> f32 {
        if self.colliders.len() < 2 {
            return 1.0;
        }
        let mut fastest = 0.0_f32;
        for (&handle, state) in self.handles.iter().zip(&self.states) {
            let body = &self.bodies[handle];
            let velocity = if body.is_dynamic() { body.linvel() } else { state.linear_velocity };
            fastest = fastest.max(velocity.length());
        }
        (fastest * dt / self.parameters.length_unit).ceil().clamp(1.0, MAXIMUM_PASSES)
    }

    /// Moves everything to the present time, `dt` after the last.
    fn advance(&mut self, dt: f32) {
        for (index, script) in self.scripts.iter().enumerate() {
            if let (BodyKind::Kinematic, Some(script)) = (self.kinds[index], script) {
                let target = pose(&script.state(self.time));
                self.bodies[self.handles[index]].set_next_kinematic_position(target);
            }
        }
        self.parameters.dt = dt;
        self.pipeline.step(
            self.gravity,
            &self.parameters,
            &mut self.islands,
            &mut self.broad_phase,
            &mut self.narrow_phase,
            &mut self.bodies,
            &mut self.colliders,
            // Joints and soft bodies are not used: empty sets cost nothing to build.
            &mut ImpulseJointSet::new(),
            &mut MultibodyJointSet::new(),
            &mut SoftBodySet::new(),
            &mut self.continuous,
            &(),
            &(),
        );
    }

    fn read_back(&mut self) -> Result<(), RigidError> {
        for (index, &handle) in self.handles.iter().enumerate() {
            let state = match &self.scripts[index] {
                Some(script) => script.state(self.time),
                None => {
                    let body = &self.bodies[handle];
                    BodyState {
                        position: body.translation(),
                        rotation: *body.rotation(),
                        linear_velocity: body.linvel(),
                        angular_velocity: body.angvel(),
                    }
                }
            };
            // rapier3d disables a body whose state is no longer finite.
            if !is_finite(&state) || !self.bodies[handle].is_enabled() {
                let body = self.names[index].clone();
                return Err(RigidError::Diverged { body, index, time: self.time });
            }
            self.states[index] = state;
        }
        Ok(())
    }
}

impl RigidEngine for RapierEngine {
    fn body_count(&self) -> usize {
        self.kinds.len()
    }

    fn kind(&self, index: usize) -> BodyKind {
        self.kinds[index]
    }

    fn state(&self, index: usize) -> BodyState {
        self.states[index]
    }

    fn inverse_mass(&self, index: usize) -> f32 {
        let mass = self.bodies[self.handles[index]].mass_properties();
        if self.held[index].is_some() { mass.local_mprops.inv_mass } else { mass.effective_inv_mass.x }
    }

    fn inverse_inertia(&self, index: usize) -> Mat3 {
        let body = &self.bodies[self.handles[index]];
        let mass = body.mass_properties();
        let m = if self.held[index].is_some() {
            mass.local_mprops.world_inv_inertia(body.rotation())
        } else {
            mass.effective_world_inv_inertia
        };
        Mat3::from_cols_array(&[m.m11, m.m12, m.m13, m.m12, m.m22, m.m23, m.m13, m.m23, m.m33])
    }

    fn step(&mut self, dt: f32, wrenches: &[Wrench]) -> Result<(), RigidError> {
        check_step(dt, wrenches, &self.names)?;
        self.check_velocities(wrenches)?;
        self.push(wrenches);
        let passes = self.passes(dt);
        let (start, share) = (self.time, dt / passes);
        let mut pass = 1.0;
        while pass <= passes {
            self.time = start + f64::from(dt) * f64::from(pass / passes);
            self.advance(share);
            pass += 1.0;
        }
        self.time = start + f64::from(dt);
        self.read_back()
    }

    fn wait(&mut self, time: f64) {
        self.time += time;
    }

    fn hold(&mut self, index: usize, is_held: bool) {
        if self.kinds[index] != BodyKind::Dynamic || self.held[index].is_some() == is_held {
            return;
        }
        let (body, state) = (&mut self.bodies[self.handles[index]], &mut self.states[index]);
        let velocities = match self.held[index].take() {
            Some(velocities) => velocities,
            None => {
                self.held[index] = Some([state.linear_velocity, state.angular_velocity]);
                [Vec3::ZERO; 2]
            }
        };
        // rapier3d's sleep follows its own islands, which include neither fluid nor sponges.
        let kind = if is_held { RigidBodyType::KinematicPositionBased } else { RigidBodyType::Dynamic };
        body.set_body_type(kind, true);
        [state.linear_velocity, state.angular_velocity] = velocities;
        body.set_linvel(state.linear_velocity, true);
        body.set_angvel(state.angular_velocity, true);
    }

    fn as_any(&self) -> Option<&dyn Any> {
        Some(self)
    }

    fn copy_from(&mut self, other: &dyn RigidEngine) -> bool {
        let Some(other) = other.as_any().and_then(|other| other.downcast_ref::<Self>()) else { return false };
        if other.states.len() != self.states.len() {
            return false;
        }
        self.take_over(other);
        true
    }

    fn save(&self, out: &mut Vec<u8>) -> Result<(), RigidError> {
        self.append_to(out)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), RigidError> {
        self.read_from(bytes)
    }

    fn set_velocity(&mut self, index: usize, linear: Vec3, angular: Vec3) -> Result<(), RigidError> {
        if self.kinds[index] == BodyKind::Dynamic {
            let body = &mut self.bodies[self.handles[index]];
            body.set_linvel(linear, true);
            body.set_angvel(angular, true);
            let state = &mut self.states[index];
            (state.linear_velocity, state.angular_velocity) = (linear, angular);
        }
        Ok(())
    }

    fn set_target(&mut self, index: usize, target: Target) -> Result<(), RigidError> {
        if let (BodyKind::Kinematic, Some(script)) = (self.kinds[index], &mut self.scripts[index]) {
            script.target = Some(target);
            self.states[index] = script.state(self.time);
        }
        Ok(())
    }

    fn contacts(&self) -> Vec<(usize, Option<usize>)> {
        self.touching()
    }

    fn set_body(&mut self, index: usize, body: &BodySetup) -> Result<(), RigidError> {
        self.replace(index, body)
    }

    fn set_gravity(&mut self, gravity: Vec3) -> Result<(), RigidError> {
        self.gravity = gravity;
        Ok(())
    }

    fn boxed_clone(&self) -> Box<dyn RigidEngine> {
        Box::new(self.clone())
    }
}

fn pose(state: &BodyState) -> Pose {
    Pose::from_parts(state.position, state.rotation)
}

fn is_finite(state: &BodyState) -> bool {
    state.position.is_finite()
        && state.rotation.is_finite()
        && state.linear_velocity.is_finite()
        && state.angular_velocity.is_finite()
}
