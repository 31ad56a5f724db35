//! The frame of the container: what of its motion is felt in it, and gravity over time.
//!
//! All positions and velocities are those in the container. In a step from t to t + h its origin goes from velocity V to V'. Its
//! axes turn by R, at a rate that goes from w to w'. All are in the axes of the container. What is free of forces keeps its velocity
//! `v + w x r + V` outside of it. In the container it has
//!
//! ```text
//! v' = R^-2 v + R^-1 (w x r) - w' x r + h (g - (V' - V) / h)
//! ```
//!
//! The last term is a gravity that is the same everywhere; mean accelerations over the step give exact impulses. The others, Euler's,
//! Coriolis's and the centrifugal acceleration, are added to the velocities before the step. The square of R is Coriolis's. One turns the
//! velocity with the axes, and one is the change of `w x r` by the way of the step.

use glam::{DMat3, DQuat, DVec3, Vec3};
use serde::{Deserialize, Serialize};
use sorb_kernels::{
    body::{Body, Wrench},
    turn::Turn,
};

use super::{StepError, World, forces::inertia};
use crate::{
    rigid::{BodyKind, Moved, RigidEngine, RigidError, moved},
    scene::{GravityKey, Motion, Scene},
};

/// Gravity over time, and the motion of the container.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Frame {
    /// Gravity outside of the container from a time \[s\] on, before the keys \[m/s^2\].
    from: (f64, Vec3),
    path: Vec<GravityKey>,
    /// Pose that the motions begin with.
    start: (DVec3, DQuat),
    #[serde(with = "crate::text")]
    motions: Vec<Motion>,
}

impl Frame {
    /// One that rests.
    pub(crate) fn at_rest(time: f64, gravity: Vec3) -> Self {
        let start = (DVec3::ZERO, DQuat::IDENTITY);
        Self { from: (time, gravity), path: Vec::new(), start, motions: Vec::new() }
    }

    /// That of a scene; none if gravity is constant and the container rests.
    pub(crate) fn of_scene(scene: &Scene) -> Option<Self> {
        if scene.container.is_still() && scene.gravity_path.is_empty() {
            return None;
        }
        let (path, motions) = (scene.gravity_path.clone(), scene.container.motions.clone());
        Some(Self { path, motions, ..Self::at_rest(0.0, scene.gravity) })
    }

    /// Gravity from a time \[s\] on: constant, or along a path.
    pub(crate) fn set_gravity(&mut self, time: f64, gravity: Vec3, path: &[GravityKey]) {
        self.from = (time, gravity);
        path.clone_into(&mut self.path);
    }

    /// Adds motions, and drops those that are over before all others.
    pub(crate) fn add_motions(&mut self, time: f64, motions: &[Motion]) {
        let is_over = |motion: &Motion| f64::from(motion.interval().1) < time;
        let over = self.motions.iter().take_while(|motion| is_over(motion)).count();
        let Moved { position, rotation, .. } = moved(self.start, &self.motions[..over], time);
        self.start = (position, rotation);
        self.motions.drain(..over);
        self.motions.extend_from_slice(motions);
    }

    /// Pose and velocity outside at a time \[s\].
    pub(crate) fn pose(&self, time: f64) -> Moved {
        let moved = moved(self.start, &self.motions, time);
        Moved { rotation: moved.rotation.normalize(), ..moved }
    }

    /// Gravity outside of the container at a time \[s\].
    pub(crate) fn gravity(&self, time: f64) -> Vec3 {
        let mut before = self.from;
        for key in &self.path {
            let (at, next) = (f64::from(key.time), key.gravity);
            if time < at {
                let share = ((time - before.0) / (at - before.0)).clamp(0.0, 1.0) as f32;
                return before.1 + (next - before.1) * share;
            }
            before = (at, next);
        }
        before.1
    }

    /// Intervals in which the container moves, or gravity changes \[s\].
    pub(crate) fn intervals(&self) -> Vec<(f64, f64)> {
        let interval = |motion: &Motion| {
            let (start, end) = motion.interval();
            (f64::from(start), f64::from(end))
        };
        let mut all: Vec<_> = self.motions.iter().map(interval).collect();
        let mut before = self.from;
        for key in &self.path {
            let next = (f64::from(key.time), key.gravity);
            if next.1 != before.1 {
                all.push((before.0, next.0));
            }
            before = next;
        }
        all
    }

    /// What is impossible, if anything is.
    #[cfg(feature = "serde")]
    pub(crate) fn defect(&self, scene: &Scene) -> Option<String> {
        let problems = GravityKey::problems(&self.path, "path").into_iter();
        let mut problems = problems.chain(crate::scene::container_problems(&self.motions, "motions", scene));
        if let Some(problem) = problems.next() {
            return Some(problem.to_string());
        }
        let (position, rotation) = self.start;
        let is_possible = self.from.0.is_finite()
            && self.from.1.is_finite()
            && position.is_finite()
            && (rotation.length_squared() - 1.0).abs() < 1e-3;
        (!is_possible).then(|| format!("a container at {position}, turned by {rotation}"))
    }
}

/// What a turn of the container in a step does to velocities.
#[derive(Clone, Copy, Debug)]
struct Spin {
    /// R^-2.
    coriolis: DMat3,
    /// R^-1 \[w\] - \[w'\], with the matrices of the cross products \[1/s\].
    field: DMat3,
    /// w and w' \[rad/s\].
    rates: [DVec3; 2],
}

impl Spin {
    /// None if the axes do not turn.
    fn between(from: &Moved, to: &Moved) -> Option<Self> {
        if from.angular == DVec3::ZERO && to.angular == DVec3::ZERO && from.rotation == to.rotation {
            return None;
        }
        let back = DMat3::from_quat(to.rotation.conjugate() * from.rotation);
        let [w, after] = [from, to].map(|moved| moved.rotation.conjugate() * moved.angular);
        let field = back * cross_product(w) - cross_product(after);
        Some(Self { coriolis: back * back, field, rates: [w, after] })
    }

    /// What it gives a dynamic body in a step \[s\].
    fn wrench(&self, engine: &dyn RigidEngine, index: usize, step: f32) -> Wrench {
        let (state, inverse_mass) = (engine.state(index), f64::from(engine.inverse_mass(index)));
        let inertia = inertia(engine.inverse_inertia(index));
        let [position, velocity, spin] =
            [state.position, state.linear_velocity, state.angular_velocity].map(|vector| vector.as_dvec3());
        if inverse_mass <= 0.0 {
            return Wrench::default();
        }
        let change = self.coriolis * velocity + self.field * position - velocity;
        let [w, after] = self.rates;
        let gyroscopic = w.cross(inertia * (spin + w)) + spin.cross(inertia * w) - inertia * spin.cross(w);
        Wrench {
            impulse: change / inverse_mass,
            angular_impulse: inertia * (w - after) - gyroscopic * f64::from(step),
        }
    }
}

/// What a turn of the container does in a step.
#[derive(Clone, Debug)]
pub(crate) struct Carried {
    /// To particles and nodes.
    pub(crate) turn: Turn,
    /// To every body.
    pub(crate) wrenches: Vec<Wrench>,
}

/// The matrix of a cross product.
fn cross_product(w: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, w.z, -w.y), DVec3::new(-w.z, 0.0, w.x), DVec3::new(w.y, -w.x, 0.0))
}

impl World {
    /// Where the container is and how it is turned, outside of it, in the frame in which it rests at time zero.
    #[must_use]
    pub fn container_pose(&self) -> (Vec3, glam::Quat) {
        let pose = self.frame.as_ref().map(|frame| frame.pose(self.clock.time));
        pose.map_or((Vec3::ZERO, glam::Quat::IDENTITY), |pose| {
            (pose.position.as_vec3(), pose.rotation.as_quat())
        })
    }

    /// Gravity as it was felt in the container in the last step, accelerations of the container included \[m/s^2\].
    #[must_use]
    pub fn gravity(&self) -> Vec3 {
        self.params.gravity
    }

    /// Another gravity outside of the container, from now on.
    pub(super) fn begin_gravity(&mut self, gravity: Vec3) -> Result<(), RigidError> {
        let time = self.clock.time;
        let Some(frame) = &mut self.frame else { return self.set_gravity(gravity) };
        frame.set_gravity(time, gravity, &[]);
        let felt = frame.pose(time).rotation.conjugate() * gravity.as_dvec3();
        self.follow_frame();
        self.set_gravity(felt.as_vec3())
    }

    /// Gravity outside of the container over time, from now on.
    pub(super) fn begin_gravity_path(&mut self, path: &[GravityKey]) {
        let time = self.clock.time;
        let frame = self.frame.get_or_insert_with(|| Frame::at_rest(time, self.params.gravity));
        frame.set_gravity(time, frame.gravity(time), path);
        self.follow_frame();
    }

    /// Further motions of the container.
    pub(super) fn begin_motions(&mut self, motions: &[Motion]) {
        let time = self.clock.time;
        let frame = self.frame.get_or_insert_with(|| Frame::at_rest(time, self.params.gravity));
        frame.add_motions(time, motions);
        self.follow_frame();
    }

    /// Tells the parts that may sleep when the container moves or gravity changes.
    pub(crate) fn follow_frame(&mut self) {
        self.sleep.carried = self.frame.as_ref().map(Frame::intervals).unwrap_or_default();
    }

    /// Whether the container moves, or gravity changes, between two times \[s\].
    pub(crate) fn is_carried(&self, from: f64, to: f64) -> bool {
        self.sleep.is_carried(from, to)
    }

    /// Lets the container move for a step \[s\]: sets the gravity that is felt in it. Returns what its turn does to velocities, which is to
    /// be done before the step; nothing if it does not turn.
    pub(crate) fn carry(&mut self, step: f32) -> Result<Option<Carried>, StepError> {
        let time = self.clock.time;
        let Some(frame) = &self.frame else { return Ok(None) };
        let h = f64::from(step);
        let (from, to) = (frame.pose(time), frame.pose(time + h));
        let gravity = frame.gravity(time + 0.5 * h).as_dvec3() - (to.linear - from.linear) / h;
        let gravity = (to.rotation.conjugate() * gravity).as_vec3();
        if gravity != self.params.gravity {
            self.set_gravity(gravity).map_err(|error| StepError::Rigid(error.to_string()))?;
            if let Some(device) = &mut self.stores.device {
                device.set_gravity(gravity);
            }
        }
        let Some(spin) = Spin::between(&from, &to) else { return Ok(None) };
        let engine = self.engine.as_ref();
        let wrench = |(index, body): (usize, &Body)| match body.kind {
            BodyKind::Dynamic => spin.wrench(engine, index, step),
            _ => Wrench::default(),
        };
        let wrenches = self.stores.host.bodies.states.0.iter().enumerate().map(wrench).collect();
        Ok(Some(Carried { turn: Turn::new(spin.coriolis.as_mat3(), spin.field.as_mat3()), wrenches }))
    }
}
