//! The scene as a whole: gravity, time, container.

use glam::Vec3;

use super::{Body, Camera, Container, Drain, Emitter, Fluid, GravityKey, Motion, Sponge};

/// Version of the scene format that this library reads and writes.
pub const VERSION: u32 = 1;

/// A complete scene: everything that exists at time zero, in SI units, Y up.
///
/// The default is an empty, unbounded scene.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Scene {
    /// Version of the format. Required in files; always 1. A file of another version is refused.
    pub version: u32,
    /// Short name: letters, digits, `_` and `-`, starting with a letter; default "scene".
    pub name: String,
    /// One line for lists and window titles; default empty.
    pub title: String,
    /// What the scene shows, in sentences; default empty.
    pub description: String,
    /// Acceleration of gravity. Range -100 to 100 m/s^2; default (0, -9.81, 0).
    ///
    /// Stronger gravity needs a higher speed of sound, hence shorter steps with `wcsph`.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub gravity: Vec3,
    /// Gravity over time: from `gravity` at time zero in straight lines from key to key, and as the last one after it; default none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub gravity_path: Vec<GravityKey>,
    /// Frames and steps.
    pub time: Time,
    /// The container; default open.
    pub domain: Domain,
    /// How the container moves; default not at all.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Container::is_still"))]
    pub container: Container,
    /// The water; absent in a dry scene, which skips all its phases.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub fluid: Option<Fluid>,
    /// Streams of water that come in; default none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub emitters: Vec<Emitter>,
    /// Boxes out of which water is taken; default none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub drains: Vec<Drain>,
    /// Sponges; default none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub sponges: Vec<Sponge>,
    /// Rigid bodies; default none.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub bodies: Vec<Body>,
    /// Point of view for pictures; by default one that sees the whole scene, see [`Scene::viewpoint`].
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub camera: Option<Camera>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            version: VERSION,
            name: "scene".to_owned(),
            title: String::new(),
            description: String::new(),
            gravity: Vec3::new(0.0, -9.81, 0.0),
            gravity_path: Vec::new(),
            time: Time::default(),
            domain: Domain::default(),
            container: Container::default(),
            fluid: None,
            emitters: Vec::new(),
            drains: Vec::new(),
            sponges: Vec::new(),
            bodies: Vec::new(),
            camera: None,
        }
    }
}

impl Scene {
    /// Empty, unbounded scene with standard gravity.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), ..Self::default() }
    }

    /// Puts the scene into a box with elastic walls, from corner to corner \[m\].
    #[must_use]
    pub fn in_box(self, minimum: Vec3, maximum: Vec3) -> Self {
        Self { domain: Domain::Box { minimum, maximum, periodic: [false; 3] }, ..self }
    }

    /// Makes the axes x, y and z that are marked periodic, see [`Domain::Box`]. An open scene stays open.
    #[must_use]
    pub fn repeating(mut self, axes: [bool; 3]) -> Self {
        if let Domain::Box { periodic, .. } = &mut self.domain {
            *periodic = axes;
        }
        self
    }

    /// Axes along which the container is periodic; none in an open scene.
    #[must_use]
    pub fn periodic(&self) -> [bool; 3] {
        match self.domain {
            Domain::Box { periodic, .. } => periodic,
            Domain::Open => [false; 3],
        }
    }

    /// Adds a motion of the container.
    #[must_use]
    pub fn moving(mut self, motion: Motion) -> Self {
        self.container.motions.push(motion);
        self
    }

    /// Sets the water.
    #[must_use]
    pub fn with_fluid(self, fluid: Fluid) -> Self {
        Self { fluid: Some(fluid), ..self }
    }

    /// Adds an emitter.
    #[must_use]
    pub fn with_emitter(mut self, emitter: Emitter) -> Self {
        self.emitters.push(emitter);
        self
    }

    /// Adds a drain.
    #[must_use]
    pub fn with_drain(mut self, drain: Drain) -> Self {
        self.drains.push(drain);
        self
    }

    /// Adds a sponge.
    #[must_use]
    pub fn with_sponge(mut self, sponge: Sponge) -> Self {
        self.sponges.push(sponge);
        self
    }

    /// Adds a rigid body.
    #[must_use]
    pub fn with_body(mut self, body: Body) -> Self {
        self.bodies.push(body);
        self
    }

    /// Sets the point of view.
    #[must_use]
    pub fn with_camera(self, camera: Camera) -> Self {
        Self { camera: Some(camera), ..self }
    }
}

/// Frames and the bounds of the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Time {
    /// Frames per second. Range 1 to 10000 1/s; default 60.
    ///
    /// A frame is filled with as many steps as stability requires. This therefore changes the output, hardly the results.
    pub frame_rate: f32,
    /// Length of a run when the caller names none. Range 0 to 100000 s; default 10.
    pub duration: f32,
    /// Longest step. Range 1e-6 to 0.1 s; default 0.004.
    ///
    /// Above about 0.005 contacts of the sponge become soft.
    pub maximum_step: f32,
    /// Shortest step. If stability requires a shorter one, the run stops with an error. Range 1e-9 to 0.1 s; default 1e-6.
    /// Not above `maximum_step`.
    pub minimum_step: f32,
    /// Courant number: step over the time in which sound and flow cross the support radius. Range 0.01 to 1; default 0.25.
    ///
    /// Above 0.4 violent scenes may become unstable.
    pub courant: f32,
    /// Time at rest after which the water, a sponge or a body sleeps, with all that it can touch. A sleeping part costs
    /// almost nothing until something comes near, or a script moves a body beside it. Range 0 to 1000 s; default 0: never.
    ///
    /// 1 s for interactive scenes. Never for measurements: water that rises more slowly than `sleep_speed` stops.
    pub sleep_after: f32,
    /// Mean speed of particles, nodes and every body, from the displacement since the last check, below which they are at
    /// rest. Range 0 to 1 m/s; default 0.001.
    pub sleep_speed: f32,
}

impl Default for Time {
    fn default() -> Self {
        Self {
            frame_rate: 60.0,
            duration: 10.0,
            maximum_step: 0.004,
            minimum_step: 1e-6,
            courant: 0.25,
            sleep_after: 0.0,
            sleep_speed: 1e-3,
        }
    }
}

/// Whether there are walls on all sides.
#[cfg(feature = "serde")]
fn is_closed(periodic: &[bool; 3]) -> bool {
    !periodic.contains(&true)
}

/// The container.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields))]
pub enum Domain {
    /// Axis-aligned box with elastic walls: the cheapest container.
    Box {
        /// Lowest corner. Range -1000 to 1000 m.
        ///
        /// Far from the origin f32 positions get coarse: keep the scene within a few metres of it.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        minimum: Vec3,
        /// Highest corner, above `minimum` on every axis. Range -1000 to 1000 m.
        #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
        maximum: Vec3,
        /// Which of the axes x, y and z are periodic; default [false, false, false].
        ///
        /// A periodic axis has no walls: water that leaves on one side enters on the other, and interacts across the sides.
        /// Sponges and bodies have no periodic images: a scene with sponges needs walls on all sides, and a body interacts
        /// at its own place only.
        #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "is_closed"))]
        periodic: [bool; 3],
    },
    /// Unbounded; a body of shape `plane` may be the floor, otherwise everything falls for ever.
    #[default]
    Open,
}
