//! Worlds for hosts that own their rigid bodies.

use sorb_kernels::{body::Wrench, clock::TIME_RESOLUTION};

use crate::{
    Options, StepError, World, WorldError,
    rigid::{HostBody, RigidError, ToldEngine, body_setups},
    scene::{Defect, Problem, Scene, SceneError},
    world::fastest_body,
};

/// A world whose bodies the host moves with a physics engine of its own, which it keeps. Shapes go in with the scene, and every sub-step
/// comes out, with its length and what it gives the bodies.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use sorb::{Coupler, Options, glam::Vec3, scene::{Body, Scene, ShapeKind}};
///
/// let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.02 }, Vec3::Y, 500.0);
/// let mut coupler = Coupler::new(&Scene::new("fall").with_body(ball), &Options::default())?;
/// coupler.advance(1.0 / 60.0, |step| {
///     // Here a host pushes its bodies, steps its engine by `step.length`, and says where they are.
///     let body = &mut step.bodies[0];
///     let push = step.wrenches[0].impulse.as_vec3() * body.inverse_mass;
///     body.state.linear_velocity += push + Vec3::NEG_Y * 9.81 * step.length;
///     body.state.position += body.state.linear_velocity * step.length;
/// })?;
/// assert!(coupler.world().bodies()[0].state.position.y < 1.0);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Coupler {
    world: World,
}

/// A step that the host takes with its own engine.
#[derive(Debug)]
#[non_exhaustive]
pub struct SubStep<'a> {
    /// Its length \[s\].
    pub length: f32,
    /// Time at its end \[s\].
    pub time: f64,
    /// What fluid, sponges and commands give every body in it, without weight: impulse \[N s\] and angular impulse \[N m s\].
    pub wrenches: &'a [Wrench],
    /// The bodies, in the order of the scene, as they were told last: the host writes what they are at the end.
    pub bodies: &'a mut [HostBody],
}

impl Coupler {
    /// Builds a scene whose bodies are those of the host. Their shapes, kinds and densities are of the scene, and
    /// [`rigid::body_setups`](crate::rigid::body_setups) lists them about their centres of mass. Contacts between bodies and with the walls
    /// of the container are up to the host.
    ///
    /// # Errors
    /// As [`World::with_options`]; motions of bodies and `time.sleep_after` are refused, because the host moves its bodies at all times.
    pub fn new(scene: &Scene, options: &Options) -> Result<Self, WorldError> {
        let mut problems = Vec::new();
        let mut refuse = |key: String, value: String, rule: &str| {
            let defect = Defect::Rule(format!("{rule}: the host moves its bodies at all times"));
            problems.push(Problem { key, value: Some(value), defect, place: None });
        };
        if scene.time.sleep_after > 0.0 {
            let value = scene.time.sleep_after.to_string();
            refuse("time.sleep_after".to_owned(), value, "must be 0 in a coupler");
        }
        for (index, body) in scene.bodies.iter().enumerate().filter(|(_, body)| !body.motions.is_empty()) {
            let value = format!("({} motions)", body.motions.len());
            refuse(format!("bodies[{index}].motions"), value, "must be empty in a coupler");
        }
        if !problems.is_empty() {
            return Err(SceneError::Invalid { file: format!("scene {}", scene.name), problems }.into());
        }
        scene.validate()?;
        let engine = ToldEngine::new(&body_setups(scene)?)?;
        Ok(Self { world: World::with_engine(scene, Box::new(engine), options)? })
    }

    /// Takes as many steps as fill some time \[s\], above 0. The host takes each of them after the world.
    ///
    /// # Errors
    /// As [`World::step`]; a time that is not finite and above 0; bodies that the host says are not finite.
    pub fn advance(&mut self, time: f64, mut host: impl FnMut(&mut SubStep<'_>)) -> Result<u32, StepError> {
        if !(time.is_finite() && time > 0.0) {
            return Err(StepError::Rigid(format!("time = {time} s is out of range: finite and above 0")));
        }
        self.world.loads.begin_frame();
        let end = self.world.clock().time + time;
        let mut steps = 0;
        while end - self.world.clock().time > TIME_RESOLUTION {
            let report = self.world.step_within(end - self.world.clock().time)?;
            self.hand_over(report.step, &mut host)?;
            steps += 1;
        }
        Ok(steps)
    }

    /// Lets the host take a step \[s\], and takes over its bodies.
    fn hand_over(&mut self, length: f32, host: &mut impl FnMut(&mut SubStep<'_>)) -> Result<(), StepError> {
        let time = self.world.clock().time;
        let result =
            match self.world.engine.as_any_mut().and_then(|engine| engine.downcast_mut::<ToldEngine>()) {
                Some(ToldEngine { bodies, wrenches, .. }) => {
                    host(&mut SubStep { length, time, wrenches, bodies });
                    self.take_over()
                }
                // It was built with this engine.
                None => Err(RigidError::Unsupported { what: "coupler" }),
            };
        result.map_err(|error| {
            let error = StepError::Rigid(error.to_string());
            self.world.failed = Some(error.clone());
            error
        })
    }

    /// Lets the host say where its bodies are and how heavy they are, outside of sub-steps. That is before the first, and when it has moved
    /// them by itself. Without it they begin with the masses of their shapes.
    ///
    /// # Errors
    /// A state or a mass that no body has; the bodies are as before.
    pub fn tell(&mut self, host: impl FnOnce(&mut [HostBody])) -> Result<(), RigidError> {
        let told = self.world.engine.as_any_mut().and_then(|engine| engine.downcast_mut::<ToldEngine>());
        let told = told.ok_or(RigidError::Unsupported { what: "coupler" })?;
        let before = told.bodies.clone();
        host(&mut told.bodies);
        if let Err(error) = told.check() {
            told.bodies = before;
            return Err(error);
        }
        self.take_over()
    }

    fn take_over(&mut self) -> Result<(), RigidError> {
        let World { engine, stores, clock, .. } = &mut self.world;
        if let Some(told) = engine.as_any().and_then(|engine| engine.downcast_ref::<ToldEngine>()) {
            told.check()?;
            let rows = &mut stores.host.bodies.states.0;
            rows.iter_mut().zip(&told.bodies).for_each(|(row, body)| row.state = body.state);
            clock.body_speed = fastest_body(rows);
        }
        Ok(())
    }

    /// The world, to look at and to ask.
    #[must_use]
    pub fn world(&self) -> &World {
        &self.world
    }

    /// The world, to push commands, to save and to roll back. Do not step it: its bodies would stay where they are.
    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }
}
