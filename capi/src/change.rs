//! Bodies, sponges and flows that come, go and change while a world runs.

use std::{ffi::c_char, mem::MaybeUninit};

use serde::de::DeserializeOwned;
use serde_json::{Value, json};
use sorb::{Command, SpongeHandle, rigid};

use crate::{
    body::BodyKind,
    command::{optional_rotation, optional_vector, push, vector},
    failure::{Failure, Status, entry},
    memory::{given, text},
    world::World,
};

/// A body or a sponge for ever: its number, and how many had that number before it, which is 0 for those of the scene. Functions that
/// take a number alone mean one with a generation of 0; in JSON a handle is `{"index": 0, "generation": 1}`, or the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Handle {
    /// Its number.
    pub index: u32,
    /// How many had this number before it.
    pub generation: u32,
}

impl Handle {
    /// The handle of the library.
    fn named<T: DeserializeOwned>(self) -> Result<T, Failure> {
        let value = json!({ "index": self.index, "generation": self.generation });
        serde_json::from_value(value).map_err(|error| wrong("handle", &error))
    }
}

fn wrong(what: &str, error: &serde_json::Error) -> Failure {
    Failure::new(Status::Command, format!("command: {what}: {error}"))
}

/// A description of a caller.
///
/// # Safety
/// `json` is null or ends with a zero.
unsafe fn described<T: DeserializeOwned>(json: *const c_char) -> Result<T, Failure> {
    // SAFETY: the promise of the caller.
    let json = unsafe { text(json, "json") }?;
    serde_json::from_str(json).map_err(|error| wrong("json", &error))
}

/// Adds a body, and gives its handle, which the next step makes valid. `json` has the keys of a body of a scene (docs/scene-format.md):
/// `{"name": "ball", "shape": {"kind": "sphere", "radius": 0.02}, "position": [0, 0.2, 0]}`. A place in a sponge or in water is refused.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_add_body(
    world: Option<&mut World>,
    json: *const c_char,
    body: Option<&mut MaybeUninit<Handle>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let description = unsafe { described(json) }?;
        let (world, out) = (given(world, "world")?, given(body, "body")?);
        let body = world.read()?.next_body();
        push(Some(world), Command::AddBody { body, description })?;
        out.write(Handle { index: body.index() as u32, generation: body.generation() });
        Ok(())
    })
}

/// Removes a body; what it held is let go.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_push_remove_body(world: Option<&mut World>, body: Handle) -> Status {
    entry(|| push(world, Command::RemoveBody { body: body.named()? }))
}

/// Gives a body another `sorb_body_kind`, where it is now. A dynamic one begins with its velocity, others rest until a pose is pushed.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_push_body_kind(world: Option<&mut World>, body: Handle, kind: u32) -> Status {
    entry(|| {
        let kind = [
            (BodyKind::Dynamic, rigid::BodyKind::Dynamic),
            (BodyKind::Fixed, rigid::BodyKind::Fixed),
            (BodyKind::Kinematic, rigid::BodyKind::Kinematic),
        ]
        .into_iter()
        .find(|(own, _)| *own as u32 == kind)
        .ok_or_else(|| Failure::new(Status::NoSuchThing, format!("no sorb_body_kind {kind}: 0 to 2")))?;
        push(world, Command::BodyKind { body: body.named()?, kind: kind.1 })
    })
}

/// Adds a sponge, with the water in its pores, and gives its handle, which the next step makes valid. `json` has the keys of a sponge of a
/// scene: `{"name": "cube", "edge": 0.02, "cells": [3, 3, 3], "position": [0, 0.1, 0]}`. Rows of nodes change. A place in a body or in
/// another sponge is refused.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_add_sponge(
    world: Option<&mut World>,
    json: *const c_char,
    sponge: Option<&mut MaybeUninit<Handle>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let description = unsafe { described(json) }?;
        let (world, out) = (given(world, "world")?, given(sponge, "sponge")?);
        let sponge = world.read()?.next_sponge();
        push(Some(world), Command::AddSponge { sponge, description })?;
        out.write(Handle { index: sponge.index() as u32, generation: sponge.generation() });
        Ok(())
    })
}

/// Removes a sponge; the water in it stays where it is. Rows of nodes change.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_push_remove_sponge(world: Option<&mut World>, sponge: Handle) -> Status {
    entry(|| push(world, Command::RemoveSponge { sponge: sponge.named()? }))
}

/// Puts a sponge elsewhere, in its shape at rest, with the water in its pores. `position` is where the middle of its block goes: 3 numbers
/// of -1000 to 1000 m. `rotation` is a quaternion of unit length, x, y, z, w, and NULL for none; `velocity` has 3 numbers of -100 to
/// 100 m/s, and NULL is at rest.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_place_sponge(
    world: Option<&mut World>,
    sponge: Handle,
    position: *const f32,
    rotation: *const f32,
    velocity: *const f32,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let position = unsafe { vector(position, "position") }?;
        // SAFETY: as above.
        let rotation = unsafe { optional_rotation(rotation) }?;
        // SAFETY: as above.
        let velocity = unsafe { optional_vector(velocity, "velocity") }?;
        push(world, Command::PlaceSponge { sponge: sponge.named()?, position, rotation, velocity })
    })
}

/// Changes the material of a sponge from the next step on: `json` has the keys that change, such as `{"young_modulus": 5000}`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_material(
    world: Option<&mut World>,
    sponge: Handle,
    json: *const c_char,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let changes: serde_json::Map<String, Value> = unsafe { described(json) }?;
        let world = given(world, "world")?;
        let sponge: SpongeHandle = sponge.named()?;
        let present = world.read()?.material(sponge).ok_or_else(|| {
            Failure::new(Status::NoSuchThing, format!("there is no sponge {sponge}, or no longer"))
        })?;
        let mut material = serde_json::to_value(present).map_err(|error| wrong("json", &error))?;
        for (key, value) in changes {
            material[key] = value;
        }
        let material = serde_json::from_value(material).map_err(|error| wrong("json", &error))?;
        push(Some(world), Command::Material { sponge, material })
    })
}

/// Begins a stream of water, and gives its number. `json` has the keys of an emitter of a scene:
/// `{"position": [0, 0.2, 0], "velocity": [0, -1, 0], "radius": 0.01}`. It begins at once if its `start` is past.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_emit(
    world: Option<&mut World>,
    json: *const c_char,
    flow: Option<&mut MaybeUninit<u32>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let emitter = unsafe { described(json) }?;
        let (world, out) = (given(world, "world")?, given(flow, "flow")?);
        let number = world.read()?.next_flow();
        push(Some(world), Command::Emit { number, emitter })?;
        out.write(number.number());
        Ok(())
    })
}

/// Opens a drain, and gives its number. `json` has the keys of a drain of a scene:
/// `{"minimum": [0, 0, 0], "maximum": [0.1, 0.02, 0.1], "rate": 0.2}`. It opens at once if its `start` is past.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_drain(
    world: Option<&mut World>,
    json: *const c_char,
    flow: Option<&mut MaybeUninit<u32>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let drain = unsafe { described(json) }?;
        let (world, out) = (given(world, "world")?, given(flow, "flow")?);
        let number = world.read()?.next_flow();
        push(Some(world), Command::Drain { number, drain })?;
        out.write(number.number());
        Ok(())
    })
}

/// Ends an emitter or a drain by its number; those of the scene count from 0, emitters first. One that has ended is refused.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_push_end_flow(world: Option<&mut World>, flow: u32) -> Status {
    entry(|| push(world, Command::EndFlow { number: flow.into() }))
}

/// Moves the container on, after the motions that it has. `json` is a list of motions of a scene, in absolute times:
/// `[{"kind": "linear", "velocity": [0.2, 0, 0], "start": 1.0, "end": 1.5, "ease": 0.1}]`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_push_container(world: Option<&mut World>, json: *const c_char) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let motions = unsafe { described(json) }?;
        push(world, Command::Container { motions })
    })
}
