//! Commands: what a host changes while a world runs.

use std::ffi::c_char;

use sorb::{
    Command, Region,
    glam::{Quat, Vec3},
};

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{given, numbers, text},
    world::World,
};

/// Pushes a command, and records it if a recording runs.
pub(crate) fn push(world: Option<&mut World>, command: Command) -> Result<(), Failure> {
    given(world, "world")?.change(|world, recorder| {
        match recorder {
            Some(recorder) => recorder.push(world, command),
            None => world.push(command),
        }
        .fails(Status::Command)
    })
}

/// A vector of a caller.
///
/// # Safety
/// `first` is null or points to three numbers.
pub(crate) unsafe fn vector(first: *const f32, name: &str) -> Result<Vec3, Failure> {
    // SAFETY: the promise of the caller.
    unsafe { numbers::<3>(first, name) }.map(Vec3::from_array)
}

/// A vector of a caller, of which NULL is zero.
///
/// # Safety
/// As [`vector`].
pub(crate) unsafe fn optional_vector(first: *const f32, name: &str) -> Result<Vec3, Failure> {
    // SAFETY: the promise of the caller.
    if first.is_null() { Ok(Vec3::ZERO) } else { unsafe { vector(first, name) } }
}

/// A rotation of a caller, of which NULL is none.
///
/// # Safety
/// `first` is null or points to four numbers.
pub(crate) unsafe fn optional_rotation(first: *const f32) -> Result<Quat, Failure> {
    if first.is_null() {
        return Ok(Quat::IDENTITY);
    }
    // SAFETY: the promise of the caller.
    unsafe { numbers::<4>(first, "rotation") }.map(Quat::from_array)
}

/// Any command, as JSON: `{"impulse": {"body": 0, "impulse": [0, 1, 0], "angular_impulse": [0, 0, 0]}}`. The next step begins with all
/// commands, in their order. docs/embedding.md lists them, with the functions below for the most frequent ones.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push(world: Option<&mut World>, json: *const c_char) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let json = unsafe { text(json, "json") }?;
        let command = serde_json::from_str(json)
            .map_err(|error| Failure::new(Status::Command, format!("command: {error}")))?;
        push(world, command)
    })
}

/// Moves a kinematic body to a pose at constant velocity and rate. `position` (m) has 3 numbers of -1000 to 1000; `rotation` is a
/// quaternion of unit length, x, y, z, w, and NULL for none; `duration` is 0.000001 to 100000 s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_pose(
    world: Option<&mut World>,
    body: u32,
    position: *const f32,
    rotation: *const f32,
    duration: f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let position = unsafe { vector(position, "position") }?;
        // SAFETY: as above.
        let rotation = unsafe { optional_rotation(rotation) }?;
        push(world, Command::Pose { body: body.into(), position, rotation, duration })
    })
}

/// Sets the velocity of a dynamic body: 3 numbers of -100 to 100 m/s, and of -1000 to 1000 rad/s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_velocity(
    world: Option<&mut World>,
    body: u32,
    linear_velocity: *const f32,
    angular_velocity: *const f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let linear_velocity = unsafe { vector(linear_velocity, "linear_velocity") }?;
        // SAFETY: as above.
        let angular_velocity = unsafe { vector(angular_velocity, "angular_velocity") }?;
        push(world, Command::Velocity { body: body.into(), linear_velocity, angular_velocity })
    })
}

/// Sets the force and the torque on a dynamic body for all steps from the next one on. Each has 3 numbers of -1e6 to 1e6, in N and N m.
/// Zeros end them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_force(
    world: Option<&mut World>,
    body: u32,
    force: *const f32,
    torque: *const f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let force = unsafe { vector(force, "force") }?;
        // SAFETY: as above.
        let torque = unsafe { vector(torque, "torque") }?;
        push(world, Command::Force { body: body.into(), force, torque })
    })
}

/// Gives a dynamic body an impulse and an angular impulse: 3 numbers each of -1e6 to 1e6 N s, and N m s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_impulse(
    world: Option<&mut World>,
    body: u32,
    impulse: *const f32,
    angular_impulse: *const f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let impulse = unsafe { vector(impulse, "impulse") }?;
        // SAFETY: as above.
        let angular_impulse = unsafe { vector(angular_impulse, "angular_impulse") }?;
        push(world, Command::Impulse { body: body.into(), impulse, angular_impulse })
    })
}

/// Sets the acceleration of gravity of everything: 3 numbers of -100 to 100 m/s^2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_gravity(world: Option<&mut World>, gravity: *const f32) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let gravity = unsafe { vector(gravity, "gravity") }?;
        push(world, Command::Gravity { gravity })
    })
}

/// Pours water into a box along the axes, from its lowest to its highest corner: 3 numbers each of -1000 to 1000 m. `velocity` has 3
/// numbers of -100 to 100 m/s, and NULL is water at rest. Places that are taken are left out; a box without any room is refused.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_pour(
    world: Option<&mut World>,
    minimum: *const f32,
    maximum: *const f32,
    velocity: *const f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let minimum = unsafe { vector(minimum, "minimum") }?;
        // SAFETY: as above.
        let maximum = unsafe { vector(maximum, "maximum") }?;
        // SAFETY: as above.
        let velocity = unsafe { optional_vector(velocity, "velocity") }?;
        push(world, Command::Pour { region: Region::Box { minimum, maximum }, velocity })
    })
}
