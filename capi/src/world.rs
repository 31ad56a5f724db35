//! Worlds: built, stepped, freed.

use std::{ffi::c_char, mem::MaybeUninit};

use sorb::Recorder;

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{check_sized, given, text, write_sized},
    options::{self, Options},
    report::{FrameReport, StepReport},
    scene::Scene,
};

/// A scene in motion.
#[derive(Debug)]
pub struct World {
    world: sorb::World,
    pub(crate) recorder: Option<Recorder>,
    /// Whether a panic may have left it in pieces.
    is_broken: bool,
}

impl World {
    pub(crate) fn hand_out(world: sorb::World, out: &mut MaybeUninit<*mut Self>) {
        let world = Self { world, recorder: None, is_broken: false };
        out.write(Box::into_raw(Box::new(world)));
    }

    /// The world, to read.
    pub(crate) fn read(&self) -> Result<&sorb::World, Failure> {
        if !self.is_broken {
            return Ok(&self.world);
        }
        Err(Failure::new(Status::Panic, "a defect of sorb has broken this world: free it"))
    }

    /// Changes the world: a panic meanwhile breaks it for good.
    pub(crate) fn change<R>(
        &mut self,
        change: impl FnOnce(&mut sorb::World, &mut Option<Recorder>) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        self.read()?;
        self.is_broken = true;
        let result = change(&mut self.world, &mut self.recorder);
        self.is_broken = false;
        result
    }
}

/// Builds a world of a scene, which it copies. NULL options are the defaults.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_new(
    scene: Option<&Scene>,
    options: *const Options,
    world: Option<&mut MaybeUninit<*mut World>>,
) -> Status {
    entry(|| {
        let (scene, out) = (given(scene, "scene")?, given(world, "world")?);
        // SAFETY: the promise of the caller.
        let options = unsafe { options::read(options) }?;
        World::hand_out(sorb::World::with_options(&scene.0, &options).fails(Status::World)?, out);
        Ok(())
    })
}

/// Copies a world, which continues with the same bits. A recording stays with the first one.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_clone(
    world: Option<&World>,
    copy: Option<&mut MaybeUninit<*mut World>>,
) -> Status {
    entry(|| {
        let copied = given(world, "world")?.read()?.clone();
        World::hand_out(copied, given(copy, "copy")?);
        Ok(())
    })
}

/// Frees a world, and all pointers that `sorb_world_view` gave.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_free(world: Option<Box<World>>) {
    entry(|| {
        drop(world);
        Ok(())
    });
}

/// Copies the scene that a world was built from.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_scene(
    world: Option<&World>,
    scene: Option<&mut MaybeUninit<*mut Scene>>,
) -> Status {
    entry(|| {
        let copied = given(world, "world")?.read()?.scene().clone();
        given(scene, "scene")?.write(Box::into_raw(Box::new(Scene(copied))));
        Ok(())
    })
}

/// Takes one step, as long as stability allows. The report may be NULL. After a failed step every further one fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_step(world: Option<&mut World>, report: *mut StepReport) -> Status {
    entry(|| {
        let world = given(world, "world")?;
        if !report.is_null() {
            // SAFETY: the promise of the caller.
            unsafe { check_sized(report) }?;
        }
        let stepped = world.change(|world, recorder| {
            match recorder {
                Some(recorder) => recorder.step(world),
                None => world.step(),
            }
            .fails(Status::Step)
        })?;
        if report.is_null() {
            return Ok(());
        }
        // SAFETY: the promise of the caller.
        unsafe { write_sized(report, &stepped.into()) }
    })
}

/// Takes as many steps as fill a frame of `1 / time.frame_rate` seconds. The report may be NULL. After a failed step every further one
/// fails.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_advance_frame(
    world: Option<&mut World>,
    report: *mut FrameReport,
) -> Status {
    entry(|| {
        let world = given(world, "world")?;
        if !report.is_null() {
            // SAFETY: the promise of the caller.
            unsafe { check_sized(report) }?;
        }
        let advanced = world.change(|world, recorder| {
            match recorder {
                Some(recorder) => recorder.advance_frame(world),
                None => world.advance_frame(),
            }
            .fails(Status::Step)
        })?;
        if report.is_null() {
            return Ok(());
        }
        // SAFETY: the promise of the caller.
        unsafe { write_sized(report, &advanced.into()) }
    })
}

/// Digest of the state: equal ones continue with the same bits.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_world_digest(world: Option<&World>, digest: Option<&mut MaybeUninit<u64>>) -> Status {
    entry(|| {
        let found = given(world, "world")?.read()?.try_digest().fails(Status::State)?;
        given(digest, "digest")?.write(found);
        Ok(())
    })
}

/// Number of a body by its name, from 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_find_body(
    world: Option<&World>,
    name: *const c_char,
    body: Option<&mut MaybeUninit<u32>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let name = unsafe { text(name, "name") }?;
        let bodies = &given(world, "world")?.read()?.scene().bodies;
        let Some(number) = bodies.iter().position(|body| body.name == name) else {
            let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
            let message = format!("no body `{name}`; bodies: {}", names.join(", "));
            return Err(Failure::new(Status::NoSuchThing, message));
        };
        given(body, "body")?.write(number as u32);
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_world_in_which_something_panicked_is_refused() {
        let mut out = MaybeUninit::uninit();
        let world = sorb::World::new(&sorb::scene::Scene::new("space")).expect("an empty scene");
        World::hand_out(world, &mut out);
        // SAFETY: written above.
        let mut world = unsafe { Box::from_raw(out.assume_init()) };
        let mut digest = MaybeUninit::uninit();
        assert_eq!(sorb_world_digest(Some(&world), Some(&mut digest)), Status::Ok);
        let status = entry(|| world.change(|_, _| -> Result<(), Failure> { panic!("planted") }));
        assert_eq!(status, Status::Panic);
        // SAFETY: the report is null.
        assert_eq!(unsafe { sorb_world_step(Some(&mut world), std::ptr::null_mut()) }, Status::Panic);
        assert_eq!(sorb_world_digest(Some(&world), Some(&mut digest)), Status::Panic);
        sorb_world_free(Some(world));
    }
}
