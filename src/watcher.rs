//! Events: what has begun and ended between two looks at a world.

use std::collections::BTreeSet;

use glam::Vec3;
use sorb_kernels::body::Body;

use crate::{
    World,
    handle::{BodyHandle, SpongeHandle},
    world::sleep::{Kind, box_of},
};

/// Distance from a body within which water touches it, over the spacing: the first layer is at half a spacing.
const WET: f32 = 0.75;

/// Distance from a body within which a node touches it, over the edge of its sponge.
const TOUCH: f32 = 0.05;

/// Rise of the mean saturation of a sponge with which absorption begins.
const BEGINS: f32 = 0.01;

/// Rise of the mean saturation within [`PAUSE`] without which absorption ends.
const GOES_ON: f32 = 0.001;

/// Time without absorption after which it has ended \[s\].
const PAUSE: f64 = 0.25;

/// What a body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Touched {
    /// Another body, of a higher number: an engine of the library tells, one of a host by
    /// [`RigidEngine::contacts`](crate::rigid::RigidEngine::contacts).
    Body(BodyHandle),
    /// A wall of the container, of which the engine tells as well.
    Wall,
    /// A sponge: a node of it is within a twentieth of its edge, or in the body.
    Sponge(SpongeHandle),
    /// Water: a particle is within three quarters of a spacing.
    Water,
}

/// A part of a scene that sleeps as a whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Part {
    /// All of the water.
    Water,
    /// A sponge.
    Sponge(SpongeHandle),
    /// A dynamic body.
    Body(BodyHandle),
}

/// Something that has begun or ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Event {
    /// A body touches something that it did not touch.
    ContactBegan(BodyHandle, Touched),
    /// It does no longer, or one of them was removed.
    ContactEnded(BodyHandle, Touched),
    /// The mean saturation of a sponge has risen by a hundredth.
    AbsorptionBegan(SpongeHandle),
    /// It has not risen by a thousandth for a quarter of a second.
    AbsorptionEnded(SpongeHandle),
    /// A part has fallen asleep.
    FellAsleep(Part),
    /// A part has woken.
    Woke(Part),
}

/// The water of a sponge between two looks.
#[derive(Clone, Copy, Debug)]
struct Absorption {
    /// Mean saturation that a rise is measured from, and when it was taken \[s\].
    from: (f32, f64),
    is_on: bool,
}

/// Looks at a world from time to time, and tells what has begun and ended since the last look. Begin with a new one: it has seen nothing.
///
/// It changes nothing in the world, so that a world that nobody watches costs nothing. What begins and ends between two looks is not seen.
/// On a GPU a look reads the state back.
///
/// ```
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// use sorb::{Event, Touched, Watcher, World, glam::Vec3, scene::{Body, Scene, ShapeKind}};
///
/// let ball = Body::dynamic("ball", ShapeKind::Sphere { radius: 0.02 }, Vec3::new(0.0, 0.022, 0.0), 500.0);
/// let scene = Scene::new("drop").in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1)).with_body(ball);
/// let (mut world, mut watcher) = (World::new(&scene)?, Watcher::new());
/// let mut events = Vec::new();
/// for _ in 0..10 {
///     world.advance_frame()?;
///     events.extend(watcher.look(&world));
/// }
/// assert_eq!(events[0], Event::ContactBegan(0.into(), Touched::Wall));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, Default)]
pub struct Watcher {
    contacts: BTreeSet<(BodyHandle, Touched)>,
    absorptions: Vec<Absorption>,
    asleep: BTreeSet<Part>,
}

impl Watcher {
    /// One that has seen nothing.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// What has begun and ended since the last look: ends before beginnings, in the order of handles.
    pub fn look(&mut self, world: &World) -> Vec<Event> {
        let mut events = Vec::new();
        let contacts = contacts(world);
        events.extend(
            self.contacts.difference(&contacts).map(|(body, with)| Event::ContactEnded(*body, *with)),
        );
        events.extend(
            contacts.difference(&self.contacts).map(|(body, with)| Event::ContactBegan(*body, *with)),
        );
        self.contacts = contacts;
        self.absorb(world, &mut events);
        let asleep = asleep(world);
        events.extend(self.asleep.difference(&asleep).map(|part| Event::Woke(*part)));
        events.extend(asleep.difference(&self.asleep).map(|part| Event::FellAsleep(*part)));
        self.asleep = asleep;
        events
    }

    fn absorb(&mut self, world: &World, events: &mut Vec<Event>) {
        let (means, time) = (saturations(world), world.clock().time);
        for (index, mean) in means.into_iter().enumerate() {
            let Some(own) = self.absorptions.get_mut(index) else {
                self.absorptions.push(Absorption { from: (mean, time), is_on: false });
                continue;
            };
            let (sponge, rise) = (SpongeHandle::from(index as u32), mean - own.from.0);
            // Another state than the one of the last look.
            let is_back = time < own.from.1;
            match own.is_on {
                false if rise >= BEGINS => {
                    *own = Absorption { from: (mean, time), is_on: true };
                    events.push(Event::AbsorptionBegan(sponge));
                }
                false if rise < 0.0 || is_back => own.from = (mean, time),
                true if rise >= GOES_ON || is_back => own.from = (mean, time),
                true if time - own.from.1 >= PAUSE => {
                    *own = Absorption { from: (mean, time), is_on: false };
                    events.push(Event::AbsorptionEnded(sponge));
                }
                _ => {}
            }
        }
    }
}

/// Mean saturation of every sponge.
fn saturations(world: &World) -> Vec<f32> {
    let (nodes, lattice) = (&world.columns().nodes, world.lattice());
    let mut sums = vec![[0.0_f64; 2]; lattice.sponges.len()];
    for (row, sponge) in lattice.node_sponge.iter().enumerate() {
        let volume = f64::from(lattice.node_volume[row]);
        // Empty before the first step, and without water.
        let saturation = nodes.saturation.get(row).map_or(0.0, |own| f64::from(own.min(1.0)));
        let sum = &mut sums[*sponge as usize];
        *sum = [sum[0] + volume * saturation, sum[1] + volume];
    }
    sums.into_iter().map(|[sum, volume]| (sum / volume) as f32).collect()
}

fn asleep(world: &World) -> BTreeSet<Part> {
    let parts = world.sleep.asleep().map(|kind| match kind {
        Kind::Fluid => Part::Water,
        Kind::Sponge(index) => Part::Sponge((index as u32).into()),
        Kind::Body(index) => Part::Body(world.handle_of(index)),
    });
    parts.collect()
}

fn contacts(world: &World) -> BTreeSet<(BodyHandle, Touched)> {
    let mut all = BTreeSet::new();
    for (first, second) in world.rigid_engine().contacts() {
        let handle = |index: usize| world.handle_of(index);
        match second {
            Some(second) => all.insert((handle(first.min(second)), Touched::Body(handle(first.max(second))))),
            None => all.insert((handle(first), Touched::Wall)),
        };
    }
    let spacing = world.params.fluid.spacing;
    for body in world.body_handles() {
        let Some(own) = world.body(body) else { continue };
        let near = |point: Vec3, reach: f32| is_near(own, point, reach);
        let mut water = world.particle_positions().iter().map(place);
        if water.any(|point| near(point, WET * spacing)) {
            all.insert((body, Touched::Water));
        }
        let nodes = world.node_positions().iter().map(place).zip(&world.lattice().node_sponge);
        for (point, sponge) in nodes {
            let touched = (body, Touched::Sponge((*sponge).into()));
            let edge = world.params.sponges[*sponge as usize].edge;
            if own.touches_nodes && !all.contains(&touched) && near(point, TOUCH * edge) {
                all.insert(touched);
            }
        }
    }
    all
}

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// Whether a point is in a body, or near its surface \[m\].
fn is_near(body: &Body, point: Vec3, reach: f32) -> bool {
    let (low, high) = box_of(body);
    point.cmpge(low - reach).all() && point.cmple(high + reach).all() && body.distance(point) <= reach
}
