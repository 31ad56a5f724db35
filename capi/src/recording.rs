//! Recordings: what a host did, with a digest of every frame.

use std::mem::MaybeUninit;

use sorb::{Player, Recorder, Recording};

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{elements, give, given},
    options::{self, Options},
    world::World,
};

/// Begins a recording with the present state: from now on it takes all commands, steps and frames. `key_frame_every` is the number of
/// frames from a save in it to the next; 0: none.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_record(world: Option<&mut World>, key_frame_every: u32) -> Status {
    entry(|| {
        given(world, "world")?.change(|world, recorder| {
            if recorder.is_some() {
                return Err(Failure::new(Status::Recording, "the world is being recorded already"));
            }
            let every = (key_frame_every > 0).then_some(key_frame_every);
            *recorder = Some(Recorder::new(world, every).fails(Status::State)?);
            Ok(())
        })
    })
}

/// Copies the recording so far: the same bytes as a file that `sorb replay` plays. `length` is the number of its bytes; a NULL buffer asks
/// for it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_recording(
    world: Option<&World>,
    buffer: *mut u8,
    capacity: usize,
    length: Option<&mut MaybeUninit<usize>>,
) -> Status {
    entry(|| {
        let world = given(world, "world")?;
        world.read()?;
        let recorder = world.recorder.as_ref().ok_or_else(none)?;
        if let Some(error) = recorder.lost_key_frame() {
            return Err(Failure::of(Status::Recording)(error));
        }
        let mut bytes = Vec::new();
        recorder.recording().write(&mut bytes).fails(Status::Recording)?;
        // SAFETY: the promise of the caller.
        unsafe { give(&bytes, (buffer, capacity), length, "buffer") }
    })
}

/// Ends the recording of a world, and forgets it.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_end_recording(world: Option<&mut World>) -> Status {
    entry(|| given(world, "world")?.change(|_, recorder| recorder.take().map(drop).ok_or_else(none)))
}

fn none() -> Failure {
    Failure::new(Status::Recording, "the world is not being recorded")
}

/// Plays a recording to its end, and compares every frame. A frame that differs is a failure that names the frame, and the first column,
/// row and both values. `frames` is the number of frames and single steps, and may be NULL; so may the options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_recording_verify(
    recording: *const u8,
    length: usize,
    options: *const Options,
    frames: Option<&mut MaybeUninit<u64>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let (bytes, options) =
            unsafe { (elements(recording, length, "recording")?, options::read(options)?) };
        let recording = Recording::read(bytes).fails(Status::Recording)?;
        let mut player = Player::new(&recording, &options).fails(Status::Recording)?;
        while player.advance().fails(Status::Recording)? {}
        if let Some(frames) = frames {
            frames.write(player.frame());
        }
        Ok(())
    })
}
