//! Bodies: where they are, and what pushes them.

use sorb::{glam::DVec3, rigid};

use crate::{
    failure::{Failure, Status, entry},
    memory::{given, versioned, write_sized},
    world::World,
};

/// What moves a body.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum BodyKind {
    /// Forces and contacts.
    Dynamic = 0,
    /// Nothing.
    Fixed = 1,
    /// Its motions, and poses that a host commands.
    Kinematic = 2,
}

/// Pose and velocity of a body.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Body {
    /// `sizeof(sorb_body)`.
    pub size: usize,
    /// What moves it: a `sorb_body_kind`.
    pub kind: u32,
    /// Centre of mass (m): x, y, z.
    pub position: [f32; 3],
    /// Rotation from its frame to the world, a quaternion of unit length: x, y, z, w.
    pub rotation: [f32; 4],
    /// Velocity of the centre of mass (m/s).
    pub linear_velocity: [f32; 3],
    /// Angular velocity, in the frame of the world (rad/s).
    pub angular_velocity: [f32; 3],
}

/// Force and torque about the centre of mass of a body.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Load {
    /// Force (N).
    pub force: [f64; 3],
    /// Torque (N m).
    pub torque: [f64; 3],
}

/// What acts on a body beside its weight, by its source: means over the steps of the last frame, zeros before the first.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct BodyLoads {
    /// `sizeof(sorb_body_loads)`.
    pub size: usize,
    /// By the fluid.
    pub fluid: Load,
    /// By sponges.
    pub sponges: Load,
    /// By forces that the host commands.
    pub host: Load,
    /// By other bodies and the walls of the container; zero for bodies that are not dynamic.
    pub contact: Load,
}

versioned! {
    Body "sorb_body",
    BodyLoads "sorb_body_loads",
}

/// Number of bodies.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_body_count(
    world: Option<&World>,
    count: Option<&mut std::mem::MaybeUninit<u32>>,
) -> Status {
    entry(|| {
        let found = given(world, "world")?.read()?.bodies().len();
        given(count, "count")?.write(found as u32);
        Ok(())
    })
}

/// Pose and velocity of a body, by its number in the scene, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_body(world: Option<&World>, number: u32, body: *mut Body) -> Status {
    entry(|| {
        let bodies = given(world, "world")?.read()?.bodies();
        let own = bodies.get(number as usize).ok_or_else(|| no_body(number, bodies.len()))?;
        let kind = match own.kind {
            rigid::BodyKind::Dynamic => BodyKind::Dynamic,
            rigid::BodyKind::Fixed => BodyKind::Fixed,
            rigid::BodyKind::Kinematic => BodyKind::Kinematic,
        };
        let own = Body {
            size: 0,
            kind: kind as u32,
            position: own.state.position.to_array(),
            rotation: own.state.rotation.to_array(),
            linear_velocity: own.state.linear_velocity.to_array(),
            angular_velocity: own.state.angular_velocity.to_array(),
        };
        // SAFETY: the promise of the caller.
        unsafe { write_sized(body, &own) }
    })
}

/// What acts on a body, by its number in the scene, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_body_loads(
    world: Option<&World>,
    number: u32,
    loads: *mut BodyLoads,
) -> Status {
    entry(|| {
        let world = given(world, "world")?.read()?;
        let count = world.bodies().len();
        if number as usize >= count {
            return Err(no_body(number, count));
        }
        let own = world.body_loads().get(number as usize).copied().unwrap_or_default();
        let load = |load: sorb::Load| {
            let [force, torque] = [load.force, load.torque].map(|vector: DVec3| vector.to_array());
            Load { force, torque }
        };
        let own = BodyLoads {
            size: 0,
            fluid: load(own.fluid),
            sponges: load(own.sponges),
            host: load(own.host),
            contact: load(own.contact),
        };
        // SAFETY: the promise of the caller.
        unsafe { write_sized(loads, &own) }
    })
}

fn no_body(number: u32, count: usize) -> Failure {
    Failure::new(Status::NoSuchThing, format!("body {number}: the scene has {count}, numbered from 0"))
}
