//! Refuses commands with values out of range, with the texts of scene keys.

mod bodies;
mod frame;
mod sponges;

use glam::{Quat, Vec3};

use super::{Command, CommandError, Nodes, Region};
use crate::{
    handle::FlowHandle,
    rigid::BodyKind,
    scene::{BlockShape, Defect, MAXIMUM_PARTICLES, Problem, limit},
    world::World,
};

/// Largest force \[N\], torque \[N m\] and impulse \[N s\].
const LARGEST: f32 = 1e6;

/// Shortest axis of a cylinder \[m\].
const SHORTEST: f32 = 1e-4;

/// How far the squared length of a rotation may be from one.
const UNIT: f32 = 1e-3;

/// Problems so far, and the world that they are of.
struct Check<'a> {
    world: &'a World,
    /// Whether the flows are those beside which the command is carried out.
    knows_flows: bool,
    /// Whether the water is that in which it is.
    knows_water: bool,
    problems: Vec<Problem>,
}

impl World {
    /// Refuses a command that this world cannot carry out.
    pub(crate) fn check_command(&self, command: &Command) -> Result<(), CommandError> {
        let mut check = Check::new(self, true, !self.has_water_commands());
        check.all(command);
        check.result()
    }

    /// The same where it is not known what the water will be like.
    #[cfg(feature = "serde")]
    pub(crate) fn check_later(&self, command: &Command) -> Result<(), CommandError> {
        let mut check = Check::new(self, false, false);
        check.all(command);
        check.result()
    }
}

impl<'a> Check<'a> {
    fn new(world: &'a World, knows_flows: bool, knows_water: bool) -> Self {
        Self { world, knows_flows, knows_water, problems: Vec::new() }
    }

    fn result(self) -> Result<(), CommandError> {
        if self.problems.is_empty() { Ok(()) } else { Err(CommandError { problems: self.problems }) }
    }
}

impl Check<'_> {
    fn all(&mut self, command: &Command) {
        self.command(command);
        if self.problems.is_empty() && self.world.has_own_engine {
            self.engine(command);
        }
    }

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
            Command::GravityPath { path } => self.gravity_path(path),
            Command::Container { motions } => self.container(motions),
            Command::Grip { body, nodes } => {
                self.body("grip.body", *body, None);
                self.nodes("grip.nodes", nodes);
                self.load(*body, nodes);
            }
            Command::Release { nodes } => self.nodes("release.nodes", nodes),
            Command::AddBody { body, description } => self.add_body(*body, description),
            Command::RemoveBody { body } => self.body("remove_body.body", *body, None),
            Command::BodyKind { body, kind } => {
                self.body("body_kind.body", *body, None);
                self.body_kind(*body, *kind);
            }
            Command::PlaceSponge { sponge, position, rotation, velocity } => {
                self.as_key("place_sponge.position", *position, "sponges[].position");
                self.rotation("place_sponge.rotation", *rotation);
                self.as_key("place_sponge.velocity", *velocity, "sponges[].velocity");
                self.sponge("place_sponge.sponge", *sponge);
                self.place(*sponge, (*position, *rotation));
            }
            Command::AddSponge { sponge, description } => self.add_sponge(*sponge, description),
            Command::RemoveSponge { sponge } => self.sponge("remove_sponge.sponge", *sponge),
            Command::Material { sponge, material } => {
                self.sponge("material.sponge", *sponge);
                self.material(*sponge, material);
            }
            Command::Pour { region, velocity } => {
                self.as_key("pour.velocity", *velocity, "fluid.blocks[].velocity");
                self.region("pour.region", region);
                self.pour(region);
            }
            Command::Emit { number, emitter } => {
                self.problems.extend(emitter.problems("emit.emitter."));
                self.begins("emit", *number, ("emitter", emitter.end));
            }
            Command::Drain { number, drain } => {
                self.problems.extend(drain.problems("drain.drain."));
                self.begins("drain", *number, ("drain", drain.end));
            }
            Command::EndFlow { number } => self.ends(*number),
            Command::Remove { region } => {
                self.region("remove.region", region);
                self.remove(region);
            }
        }
    }

    fn nodes(&mut self, key: &str, nodes: &Nodes) {
        match nodes {
            Nodes::Sphere { centre, radius } => {
                self.as_key(&format!("{key}.centre"), *centre, "sponges[].position");
                self.number(&format!("{key}.radius"), *radius, (1e-4, 100.0, "m"));
            }
            Nodes::Rows(rows) => {
                if !self.knows_flows {
                    return;
                }
                if self.world.has_node_commands() {
                    let rule = "a command that waits changes the rows of nodes; take a step first".to_owned();
                    self.rule(&format!("{key}.rows"), format!("({} rows)", rows.len()), rule);
                    return;
                }
                let count = self.world.node_positions().len();
                if let Some(row) = rows.iter().find(|row| **row as usize >= count) {
                    let rule = format!("no such node; there are {count}, numbered from 0");
                    self.rule(&format!("{key}.rows"), row.to_string(), rule);
                }
            }
        }
    }

    fn corners(&mut self, key: &str, minimum: Vec3, maximum: Vec3) {
        self.as_key(&format!("{key}.minimum"), minimum, "sponges[].position");
        self.as_key(&format!("{key}.maximum"), maximum, "sponges[].position");
        if !minimum.cmplt(maximum).all() {
            let rule = format!("must be above `{key}.minimum` = {minimum} along every axis");
            self.rule(&format!("{key}.maximum"), maximum.to_string(), rule);
        }
    }

    fn region(&mut self, key: &str, region: &Region) {
        let mut place = |name: &str, value: Vec3| {
            self.as_key(&format!("{key}.{name}"), value, "sponges[].position");
        };
        let radius = match *region {
            Region::Box { minimum, maximum } => return self.corners(&format!("{key}.box"), minimum, maximum),
            Region::Block { minimum, maximum, ref shape } => {
                self.corners(&format!("{key}.block"), minimum, maximum);
                let table = format!("{key}.block.shape");
                shape.ranges(&table, &mut self.problems);
                shape.rules(&table, &mut self.problems);
                if cfg!(not(feature = "rigid")) && matches!(**shape, BlockShape::Mesh { .. }) {
                    self.rule(&table, "mesh".to_owned(), "needs the feature `rigid`".to_owned());
                }
                return;
            }
            Region::Sphere { centre, radius } => {
                place("sphere.centre", centre);
                ("sphere", radius)
            }
            Region::Cylinder { start, end, radius } => {
                place("cylinder.start", start);
                place("cylinder.end", end);
                if start.distance(end) < SHORTEST {
                    let rule = format!("must be at least {SHORTEST} m from `{key}.cylinder.start` = {start}");
                    self.rule(&format!("{key}.cylinder.end"), end.to_string(), rule);
                }
                ("cylinder", radius)
            }
        };
        self.number(&format!("{key}.{}.radius", radius.0), radius.1, (1e-4, 100.0, "m"));
    }

    /// A pour of a scene with fluid, of a possible number of particles, for which there is any room.
    fn pour(&mut self, region: &Region) {
        if !self.problems.is_empty() {
            return;
        }
        let (world, value) = (self.world, format!("{region:?}"));
        let Some(fluid) = &world.scene().fluid else {
            let rule =
                "the scene has no `fluid`; one without blocks and sponges that are wet has no particles yet";
            self.rule("pour.region", value, rule.to_owned());
            return;
        };
        let (wanted, present) = (region.lattice_size(fluid.spacing), world.stores.host.rows.fluid);
        if wanted + present as f64 > MAXIMUM_PARTICLES as f64 {
            let rule = format!(
                "asks for up to {wanted:.0} particles, and {present} are there; the range is 0 to {MAXIMUM_PARTICLES} \
                 in all"
            );
            self.rule("pour.region", value, rule);
            return;
        }
        let given = world.water.identities();
        if wanted > u64::from(u32::MAX).saturating_sub(given) as f64 {
            let rule = format!("{given} particles have had a number of their own, of {} at most", u32::MAX);
            self.rule("pour.region", value, rule);
            return;
        }
        // What commands before it do to the water is not known yet.
        if self.knows_water {
            let room = world.room(region);
            if room.points.is_empty() {
                self.rule("pour.region", value, room.to_string());
            }
        }
    }

    /// A flow with the next number in a scene with fluid, which has not ended before it begins.
    fn begins(&mut self, key: &str, number: FlowHandle, (kind, end): (&str, f32)) {
        let world = self.world;
        if world.scene().fluid.is_none() {
            self.rule(key, number.to_string(), "the scene has no `fluid`".to_owned());
        }
        if !self.knows_flows || !self.problems.is_empty() {
            return;
        }
        let next = world.next_flow();
        if number != next {
            let rule = format!("no number is used twice; the next one is {next}");
            self.rule(&format!("{key}.number"), number.to_string(), rule);
        }
        if f64::from(end) <= world.clock().time {
            let rule = format!("must be after the present time, {} s", world.clock().time);
            self.rule(&format!("{key}.{kind}.end"), end.to_string(), rule);
        }
    }

    /// A flow that has not ended.
    fn ends(&mut self, number: FlowHandle) {
        if self.knows_flows && !self.world.has_flow(number) {
            let rule = "no such emitter or drain; it has ended, or never began".to_owned();
            self.rule("end_flow.number", number.to_string(), rule);
        }
    }

    /// A removal of any water.
    fn remove(&mut self, region: &Region) {
        if !self.problems.is_empty() || !self.knows_water {
            return;
        }
        let (rows, is_inside) = (self.world.particle_positions(), region.inside());
        if !rows.iter().any(|row| is_inside(Vec3::new(row[0], row[1], row[2]))) {
            let rule = format!("holds none of {} particles", rows.len());
            self.rule("remove.region", format!("{region:?}"), rule);
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
