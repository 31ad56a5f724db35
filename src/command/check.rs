//! Refuses commands with values out of range, with the texts of scene keys.

use glam::{Quat, Vec3};

use super::{Command, CommandError, Nodes};
use crate::{
    rigid::BodyKind,
    scene::{Defect, Problem, limit},
    world::World,
};

/// Largest force \[N\], torque \[N m\] and impulse \[N s\].
const LARGEST: f32 = 1e6;

/// How far the squared length of a rotation may be from one.
const UNIT: f32 = 1e-3;

/// Problems so far, and the world that they are of.
struct Check<'a> {
    world: &'a World,
    problems: Vec<Problem>,
}

impl World {
    /// Refuses a command that this world cannot carry out.
    pub(crate) fn check_command(&self, command: &Command) -> Result<(), CommandError> {
        let mut check = Check { world: self, problems: Vec::new() };
        check.command(command);
        if check.problems.is_empty() && self.has_own_engine {
            check.engine(command);
        }
        if check.problems.is_empty() { Ok(()) } else { Err(CommandError { problems: check.problems }) }
    }
}

impl Check<'_> {
    fn command(&mut self, command: &Command) {
        use BodyKind::{Dynamic, Kinematic};
        match command {
            Command::Force { body, force, torque } => {
                self.body("force.body", *body, Some(Dynamic));
                self.vector("force.force", *force, (LARGEST, "N"));
                self.vector("force.torque", *torque, (LARGEST, "N m"));
            }
            Command::Impulse { body, impulse, angular_impulse } => {
                self.body("impulse.body", *body, Some(Dynamic));
                self.vector("impulse.impulse", *impulse, (LARGEST, "N s"));
                self.vector("impulse.angular_impulse", *angular_impulse, (LARGEST, "N m s"));
            }
            Command::Velocity { body, linear_velocity, angular_velocity } => {
                self.body("velocity.body", *body, Some(Dynamic));
                self.as_key("velocity.linear_velocity", *linear_velocity, "bodies[].linear_velocity");
                self.as_key("velocity.angular_velocity", *angular_velocity, "bodies[].angular_velocity");
            }
            Command::Pose { body, position, rotation, duration } => {
                self.body("pose.body", *body, Some(Kinematic));
                self.as_key("pose.position", *position, "bodies[].position");
                self.rotation("pose.rotation", *rotation);
                self.number("pose.duration", *duration, (1e-6, 1e5, "s"));
            }
            Command::Gravity { gravity } => self.as_key("gravity.gravity", *gravity, "gravity"),
            Command::Grip { body, nodes } => {
                self.body("grip.body", *body, None);
                self.nodes("grip.nodes", nodes);
            }
            Command::Release { nodes } => self.nodes("release.nodes", nodes),
        }
    }

    /// What an engine of a host refuses: tried on a copy, because a step must not fail by it later.
    fn engine(&mut self, command: &Command) {
        let mut engine = self.world.engine.boxed_clone();
        let (key, value, tried) = match command {
            Command::Impulse { body, .. } => {
                ("impulse.body", *body, engine.set_velocity(*body as usize, Vec3::ZERO, Vec3::ZERO))
            }
            Command::Velocity { body, linear_velocity, angular_velocity } => {
                let tried = engine.set_velocity(*body as usize, *linear_velocity, *angular_velocity);
                ("velocity.body", *body, tried)
            }
            Command::Pose { body, position, rotation, duration } => {
                let target = self.world.target(*body as usize, (*position, *rotation), *duration);
                ("pose.body", *body, engine.set_target(*body as usize, target))
            }
            Command::Gravity { gravity } => {
                if let Err(error) = engine.set_gravity(*gravity) {
                    self.rule("gravity.gravity", gravity.to_string(), error.to_string());
                }
                return;
            }
            _ => return,
        };
        if let Err(error) = tried {
            self.rule(key, value.to_string(), error.to_string());
        }
    }

    /// A body that exists, of a kind.
    fn body(&mut self, key: &str, body: u32, kind: Option<BodyKind>) {
        let bodies = self.world.bodies();
        let rule = match (bodies.get(body as usize), kind) {
            (None, _) => format!("no such body; there are {}, numbered from 0", bodies.len()),
            (Some(found), Some(kind)) if found.kind != kind => {
                format!("the body is {:?}, and must be {kind:?}", found.kind).to_lowercase()
            }
            _ => return,
        };
        self.rule(key, body.to_string(), rule);
    }

    fn nodes(&mut self, key: &str, nodes: &Nodes) {
        match nodes {
            Nodes::Sphere { centre, radius } => {
                self.as_key(&format!("{key}.centre"), *centre, "sponges[].position");
                self.number(&format!("{key}.radius"), *radius, (1e-4, 100.0, "m"));
            }
            Nodes::Rows(rows) => {
                let count = self.world.node_positions().len();
                if let Some(row) = rows.iter().find(|row| **row as usize >= count) {
                    let rule = format!("no such node; there are {count}, numbered from 0");
                    self.rule(&format!("{key}.rows"), row.to_string(), rule);
                }
            }
        }
    }

    fn rotation(&mut self, key: &str, rotation: Quat) {
        // A length that is not a number fails the comparison as well.
        let is_unit = (rotation.length_squared() - 1.0).abs() <= UNIT;
        if !is_unit {
            self.rule(key, rotation.to_string(), "must be a quaternion of unit length".to_owned());
        }
    }

    /// In the range of a key of a scene.
    fn as_key(&mut self, key: &str, value: Vec3, like: &str) {
        if let Some(limit) = limit(like) {
            value
                .to_array()
                .into_iter()
                .for_each(|value| self.number(key, value, (limit.minimum, limit.maximum, limit.unit)));
        }
    }

    fn vector(&mut self, key: &str, value: Vec3, (largest, unit): (f32, &'static str)) {
        value.to_array().into_iter().for_each(|value| self.number(key, value, (-largest, largest, unit)));
    }

    fn number(&mut self, key: &str, value: f32, (minimum, maximum, unit): (f32, f32, &'static str)) {
        if !(minimum..=maximum).contains(&value) {
            let defect = Defect::OutOfRange { minimum, maximum, unit };
            let (key, value) = (key.to_owned(), Some(crate::scene::number_text(value)));
            self.problems.push(Problem { key, value, defect, place: None });
        }
    }

    fn rule(&mut self, key: &str, value: String, rule: String) {
        let (key, defect) = (key.to_owned(), Defect::Rule(rule));
        self.problems.push(Problem { key, value: Some(value), defect, place: None });
    }
}
