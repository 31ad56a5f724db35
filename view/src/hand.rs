//! The hand: grips a sponge, pulls a body, stirs and pours water. All that it does are commands, which recordings hold.

use sorb::{
    BodyHandle, Command, Hit, Nodes, Region, Surface, World,
    glam::{Quat, Vec3},
    rigid::BodyKind,
    scene::{Body, Domain, Look, ShapeKind},
};

use crate::{ViewError, session::Session};

/// Fastest motion of a hand \[m/s\]: water and sponge follow it.
const FASTEST: f32 = 0.8;
/// Angular frequency with which a pulled body follows \[1/s\], critically damped.
const PULL: f32 = 14.0;
/// Largest acceleration of a pulled body over that of gravity.
const STRONGEST: f32 = 8.0;
/// Radius of a grip over the edge of the cells of the sponge.
const GRIP: f32 = 1.6;
/// Radius of a finger in water over the spacing.
const FINGER: f32 = 2.5;
/// Radius of what is poured in a frame over the spacing.
const JET: f32 = 2.1;
/// Velocity of what is poured \[m/s\].
const FALL: Vec3 = Vec3::new(0.0, -0.6, 0.0);
/// Share of the container that a hand leaves free at its walls.
const MARGIN: f32 = 0.06;

/// What is held, and how.
#[derive(Clone, Debug)]
enum Held {
    /// Nodes of a sponge, by a body without a contact.
    Sponge { grip: BodyHandle, rows: Vec<u32>, offset: Vec3 },
    /// A body that forces move, by a spring.
    Dynamic { body: BodyHandle, offset: Vec3 },
    /// A body that goes where it is told.
    Kinematic { body: BodyHandle, offset: Vec3 },
    /// A ball that was put into the water.
    Finger { body: BodyHandle },
}

/// The hand of a window.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    held: Option<Held>,
    /// Where the hand shall be.
    target: Vec3,
    /// Where it is.
    at: Vec3,
    /// Where water is poured.
    spout: Option<Vec3>,
    /// The body that grips, once there is one: it stays.
    grip: Option<BodyHandle>,
}

impl Hand {
    /// Takes what a ray has met. Its name; none for what cannot be taken.
    ///
    /// # Errors
    /// The world refuses a command, or a recording plays.
    pub fn take(&mut self, session: &mut Session<'_>, hit: &Hit) -> Result<Option<String>, ViewError> {
        self.let_go(session)?;
        (self.target, self.at) = (hit.point, hit.point);
        match hit.surface {
            Surface::Sponge(index) => self.take_sponge(session, index, hit.point),
            Surface::Body(index) => Ok(self.take_body(session.world(), index, hit.point)),
            Surface::Water => self.dip(session, hit.point),
            _ => Ok(None),
        }
    }

    /// Where the hand shall go \[m\]; it stays in the container.
    pub fn reach(&mut self, world: &World, point: Vec3) {
        self.target = inside(world, point);
    }

    /// Pours water at a place from now on, or ends that.
    pub fn pour(&mut self, spout: Option<Vec3>) {
        self.spout = spout;
    }

    /// Whether it holds or pours anything.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.held.is_some() || self.spout.is_some()
    }

    /// Lets go of what it holds.
    ///
    /// # Errors
    /// The world refuses a command.
    pub fn let_go(&mut self, session: &mut Session<'_>) -> Result<(), ViewError> {
        match self.held.take() {
            Some(Held::Sponge { rows, .. }) => session.push(Command::Release { nodes: Nodes::Rows(rows) }),
            Some(Held::Dynamic { body, .. }) => {
                session.push(Command::Force { body, force: Vec3::ZERO, torque: Vec3::ZERO })
            }
            Some(Held::Finger { body }) => session.push(Command::RemoveBody { body }),
            Some(Held::Kinematic { .. }) | None => Ok(()),
        }
    }

    /// Pushes the commands of the next frame, which takes so long \[s\].
    ///
    /// # Errors
    /// The world refuses a command.
    pub fn act(&mut self, session: &mut Session<'_>, duration: f32) -> Result<(), ViewError> {
        if let Some(spout) = self.spout {
            pour(session, spout);
        }
        let Some(held) = &self.held else { return Ok(()) };
        let way = self.target - self.at;
        let most = FASTEST * duration;
        self.at = if way.length() > most { self.at + way.normalize_or_zero() * most } else { self.target };
        let world = session.world();
        let command = match *held {
            Held::Sponge { grip: body, offset, .. } | Held::Kinematic { body, offset } => {
                let rotation = world.body(body).map_or(Quat::IDENTITY, |body| body.state.rotation);
                Command::Pose { body, position: self.at + offset, rotation, duration }
            }
            Held::Finger { body } => {
                Command::Pose { body, position: self.at, rotation: Quat::IDENTITY, duration }
            }
            Held::Dynamic { body, offset } => {
                let Some(force) = pull(world, body, self.target + offset) else { return Ok(()) };
                Command::Force { body, force, torque: Vec3::ZERO }
            }
        };
        session.push(command)
    }

    fn take_sponge(
        &mut self,
        session: &mut Session<'_>,
        index: usize,
        point: Vec3,
    ) -> Result<Option<String>, ViewError> {
        let world = session.world();
        let rows = free_nodes(world, index, point);
        let name = world.scene().sponges.get(index).map(|sponge| sponge.name.clone());
        if rows.is_empty() {
            return Ok(None);
        }
        let grip = match self.grip {
            Some(grip) => grip,
            None => {
                let (grip, home) = (world.next_body(), world.scene().bounds().1 + Vec3::Y);
                let shape = ShapeKind::Sphere { radius: 1e-3 };
                let hand =
                    Body { look: Some(Look::Wire), ..Body::kinematic("view-hand", shape, home, Vec::new()) };
                session.push(Command::AddBody { body: grip, description: Box::new(hand) })?;
                // It is there from the next step on.
                self.grip = Some(grip);
                grip
            }
        };
        let home = session.world().scene().bounds().1 + Vec3::Y;
        let from = session.world().body(grip).map_or(home, |body| body.state.position);
        session.push(Command::Grip { body: grip, nodes: Nodes::Rows(rows.clone()) })?;
        self.held = Some(Held::Sponge { grip, rows, offset: from - point });
        Ok(name)
    }

    fn take_body(&mut self, world: &World, index: usize, point: Vec3) -> Option<String> {
        let body = world.body_handles().find(|body| body.index() == index)?;
        let (own, keys) = (world.body(body)?, world.scene().bodies.get(index)?);
        let offset = own.state.position - point;
        self.held = Some(match own.kind {
            BodyKind::Dynamic => Held::Dynamic { body, offset },
            BodyKind::Kinematic => Held::Kinematic { body, offset },
            BodyKind::Fixed => return None,
        });
        Some(keys.name.clone())
    }

    /// Puts a finger into the water: a ball that begins above it.
    fn dip(&mut self, session: &mut Session<'_>, point: Vec3) -> Result<Option<String>, ViewError> {
        let world = session.world();
        let Some(spacing) = world.scene().fluid.as_ref().map(|fluid| fluid.spacing) else { return Ok(None) };
        let (radius, body) = (FINGER * spacing, world.next_body());
        let mut refused = None;
        for height in 1..12 {
            let begin = point + Vec3::Y * (radius + spacing * (2 * height) as f32);
            let ball = Body::kinematic("view-finger", ShapeKind::Sphere { radius }, begin, Vec::new());
            match session.push(Command::AddBody { body, description: Box::new(ball) }) {
                Ok(()) => {
                    self.at = begin;
                    self.held = Some(Held::Finger { body });
                    return Ok(Some("water".to_owned()));
                }
                Err(error) => refused = Some(error),
            }
        }
        refused.map_or(Ok(None), Err)
    }
}

/// Nodes of a sponge near a point that nothing holds.
fn free_nodes(world: &World, index: usize, point: Vec3) -> Vec<u32> {
    let lattice = world.lattice();
    let Some(reach) = lattice.sponges.get(index).map(|sponge| GRIP * sponge.edge) else { return Vec::new() };
    let nodes = world.node_positions().iter().zip(&lattice.node_sponge).enumerate();
    let near = nodes.filter(|(_, ([x, y, z, inverse_mass], sponge))| {
        let is_near = Vec3::new(*x, *y, *z).distance(point) <= reach;
        **sponge as usize == index && is_near && *inverse_mass > 0.0
    });
    near.map(|(row, _)| row as u32).collect()
}

/// The force of a critically damped spring that also carries the weight of a body \[N\].
fn pull(world: &World, body: BodyHandle, target: Vec3) -> Option<Vec3> {
    let own = world.body(body).filter(|body| body.inverse_mass > 0.0)?;
    let gravity = world.gravity();
    let pull = (target - own.state.position) * (PULL * PULL) - own.state.linear_velocity * (2.0 * PULL);
    let acceleration = pull.clamp_length_max(STRONGEST * gravity.length().max(1.0)) - gravity;
    Some(acceleration / own.inverse_mass)
}

/// Pours the water of a frame. Where the last of it is still in the way there is no room, which is no error.
fn pour(session: &mut Session<'_>, spout: Vec3) {
    let Some(spacing) = session.world().scene().fluid.as_ref().map(|fluid| fluid.spacing) else { return };
    let region = Region::Sphere { centre: spout, radius: JET * spacing };
    let _ = session.push(Command::Pour { region, velocity: FALL });
}

/// The nearest place in the container, less a margin.
fn inside(world: &World, point: Vec3) -> Vec3 {
    let Domain::Box { minimum, maximum, .. } = world.scene().domain else {
        return point.clamp(Vec3::splat(-900.0), Vec3::splat(900.0));
    };
    let margin = (maximum - minimum) * MARGIN;
    point.clamp(minimum + margin, maximum - margin)
}

/// Where water has to be poured so that it falls on what a ray meets: above that place, in the container.
///
/// # Errors
/// The world refuses the ray.
pub fn spout(world: &World, ray: sorb::Ray) -> Result<Option<Vec3>, sorb::QueryError> {
    let (low, high) = world.scene().bounds();
    let hits = world.cast_rays(&[ray], sorb::Targets::ALL)?;
    let floor = || {
        let distance = (low.y - ray.origin.y) / ray.direction.y;
        (distance > 0.0 && distance < ray.length).then(|| ray.origin + ray.direction * distance)
    };
    let place = hits.first().copied().flatten().map(|hit| hit.point).or_else(floor);
    let above = 0.3 * (high.y - low.y);
    Ok(place.map(|place| inside(world, place + Vec3::Y * above)))
}
