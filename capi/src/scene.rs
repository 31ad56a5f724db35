//! Scenes.

use std::{
    ffi::{CStr, c_char},
    mem::MaybeUninit,
};

use sorb::scene;

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{give, given, text},
};

/// A scene: everything that a world begins with.
#[derive(Debug)]
pub struct Scene(pub(crate) scene::Scene);

/// Version of the library, such as "0.1.0". Valid for ever.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_version() -> *const c_char {
    const VERSION: Result<&CStr, std::ffi::FromBytesWithNulError> =
        CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes());
    VERSION.unwrap_or_default().as_ptr()
}

/// Hands a scene out.
fn hand_out(
    scene: Result<scene::Scene, scene::SceneError>,
    out: &mut MaybeUninit<*mut Scene>,
) -> Result<(), Failure> {
    let scene = scene.fails(Status::Scene)?;
    out.write(Box::into_raw(Box::new(Scene(scene))));
    Ok(())
}

/// Reads a scene that comes with the library, such as `ball_drop`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_preset(
    name: *const c_char,
    scene: Option<&mut MaybeUninit<*mut Scene>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let name = unsafe { text(name, "name") }?;
        hand_out(scene::preset(name), given(scene, "scene")?)
    })
}

/// Reads a scene from a file whose name ends in `.toml` or `.json`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_from_file(
    path: *const c_char,
    scene: Option<&mut MaybeUninit<*mut Scene>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let path = unsafe { text(path, "path") }?;
        hand_out(scene::Scene::from_path(path), given(scene, "scene")?)
    })
}

/// Reads a scene from TOML.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_from_toml(
    toml: *const c_char,
    scene: Option<&mut MaybeUninit<*mut Scene>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let toml = unsafe { text(toml, "toml") }?;
        hand_out(scene::Scene::from_toml(toml, "scene"), given(scene, "scene")?)
    })
}

/// Reads a scene from JSON.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_from_json(
    json: *const c_char,
    scene: Option<&mut MaybeUninit<*mut Scene>>,
) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let json = unsafe { text(json, "json") }?;
        hand_out(scene::Scene::from_json(json, "scene"), given(scene, "scene")?)
    })
}

/// Changes one key: `fluid.spacing=0.004`, `sponges.NAME.porosity=0.8`, `bodies[0].position=[0, 0.1, 0]`. The value is TOML.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_set(scene: Option<&mut Scene>, change: *const c_char) -> Status {
    entry(|| {
        // SAFETY: the promise of the caller.
        let change = unsafe { text(change, "change") }?;
        given(scene, "scene")?.0.set(change).fails(Status::Scene)
    })
}

/// Refines a scene, range 0.1 to 8: twice the resolution has 8 times the particles and nodes.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_scene_scale(scene: Option<&mut Scene>, resolution: f32) -> Status {
    entry(|| {
        let scene = given(scene, "scene")?;
        scene.0 = scene.0.clone().scaled(resolution).fails(Status::Scene)?;
        Ok(())
    })
}

/// Copies a scene as JSON, without a zero at its end. `length` is the number of its bytes; a NULL buffer asks for it alone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_scene_to_json(
    scene: Option<&Scene>,
    buffer: *mut u8,
    capacity: usize,
    length: Option<&mut MaybeUninit<usize>>,
) -> Status {
    entry(|| {
        let json = given(scene, "scene")?.0.to_json().fails(Status::Scene)?;
        // SAFETY: the promise of the caller.
        unsafe { give(json.as_bytes(), (buffer, capacity), length, "buffer") }
    })
}

/// Frees a scene.
#[unsafe(no_mangle)]
pub extern "C" fn sorb_scene_free(scene: Option<Box<Scene>>) {
    entry(|| {
        drop(scene);
        Ok(())
    });
}
