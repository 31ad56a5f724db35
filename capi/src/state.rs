//! Saves and snapshots.

use std::mem::MaybeUninit;

use sorb::Save;

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{elements, give, given},
    options::{self, Options},
    world::World,
};

/// A state in memory, to roll back to.
#[derive(Debug, Default)]
pub struct Snapshot(sorb::Snapshot);

/// Copies the state with its scene as a save: the same bytes as a file that `sorb run --from` reads. `length` is the number of its
/// bytes; a NULL buffer asks for it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_save(
    world: Option<&World>,
    buffer: *mut u8,
    capacity: usize,
    length: Option<&mut MaybeUninit<usize>>,
) -> Status {
    entry(|| {
        let mut bytes = Vec::new();
        given(world, "world")?.read()?.save(&mut bytes).fails(Status::State)?;
        // SAFETY: the promise of the caller.
        unsafe { give(&bytes, (buffer, capacity), length, "buffer") }
    })
}

/// Builds a world in the state of a save, which continues with the same bits. NULL options are the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_restore(
    save: *const u8,
    length: usize,
    options: *const Options,
    world: Option<&mut MaybeUninit<*mut World>>,
) -> Status {
    entry(|| {
        let out = given(world, "world")?;
        // SAFETY: the promise of the caller.
        let (bytes, options) = unsafe { (elements(save, length, "save")?, options::read(options)?) };
        World::hand_out(sorb::World::restore(bytes, &options).fails(Status::State)?, out);
        Ok(())
    })
}

/// Returns to the state of a save of the same scene, without building anything anew. Refused while a recording runs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_resume(
    world: Option<&mut World>,
    save: *const u8,
    length: usize,
) -> Status {
    entry(|| {
        let world = not_recording(given(world, "world")?)?;
        // SAFETY: the promise of the caller.
        let save = Save::read(unsafe { elements(save, length, "save") }?).fails(Status::State)?;
        world.change(|world, _| world.resume(&save).fails(Status::State))
    })
}

/// Makes an empty snapshot.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_snapshot_new(snapshot: Option<&mut MaybeUninit<*mut Snapshot>>) -> Status {
    entry(|| {
        given(snapshot, "snapshot")?.write(Box::into_raw(Box::default()));
        Ok(())
    })
}

/// Frees a snapshot.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_snapshot_free(snapshot: Option<Box<Snapshot>>) {
    entry(|| {
        drop(snapshot);
        Ok(())
    });
}

/// Copies the state into a snapshot, in the memory that it has already.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_snapshot(world: Option<&World>, snapshot: Option<&mut Snapshot>) -> Status {
    entry(|| {
        given(world, "world")?.read()?.snapshot_into(&mut given(snapshot, "snapshot")?.0);
        Ok(())
    })
}

/// Returns to a snapshot of this world. Refused while a recording runs, and for an empty snapshot or one of another scene.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_rollback(world: Option<&mut World>, snapshot: Option<&Snapshot>) -> Status {
    entry(|| {
        let (world, snapshot) = (not_recording(given(world, "world")?)?, given(snapshot, "snapshot")?);
        world.change(|world, _| world.rollback(&snapshot.0).fails(Status::State))
    })
}

/// A recording holds what a host does from frame to frame, not jumps of the state.
fn not_recording(world: &mut World) -> Result<&mut World, Failure> {
    if world.recorder.is_none() {
        return Ok(world);
    }
    Err(Failure::new(Status::Recording, "the world is being recorded: end the recording first"))
}
