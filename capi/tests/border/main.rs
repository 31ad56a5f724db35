//! The C interface as a caller uses and misuses it: bad input is a status and a text, and nothing is lost.
#![allow(unsafe_code, reason = "calls what C calls")]

mod changed;
mod refused;
mod used;

use std::{
    ffi::CStr,
    mem::MaybeUninit,
    ptr::{null, null_mut},
};

use sorb_capi::*;

/// The only body.
const BALL: u32 = 0;

fn last() -> String {
    // SAFETY: never null, and ends with a zero.
    unsafe { CStr::from_ptr(sorb_last_error()) }.to_string_lossy().into_owned()
}

/// A handle that a call gives.
fn given<T>(call: impl FnOnce(Option<&mut MaybeUninit<T>>) -> Status) -> T {
    let mut out = MaybeUninit::uninit();
    let status = call(Some(&mut out));
    assert_eq!(status, Status::Ok, "{}", last());
    // SAFETY: the call succeeded.
    unsafe { out.assume_init() }
}

/// A world that is freed at the end.
struct Own(*mut World);

impl Own {
    fn small() -> Self {
        // SAFETY: texts that end with a zero, and handles of the library.
        unsafe {
            let scene = given(|out| sorb_scene_preset(c"ball_drop".as_ptr(), out));
            assert_eq!(sorb_scene_scale(Some(&mut *scene), 0.3), Status::Ok, "{}", last());
            let world = Self(given(|out| sorb_world_new(Some(&*scene), null(), out)));
            sorb_scene_free(Some(Box::from_raw(scene)));
            world
        }
    }

    fn get(&self) -> Option<&World> {
        // SAFETY: not freed yet.
        Some(unsafe { &*self.0 })
    }

    fn get_mut(&mut self) -> Option<&mut World> {
        // SAFETY: not freed yet.
        Some(unsafe { &mut *self.0 })
    }

    fn digest(&self) -> u64 {
        given(|out| sorb_world_digest(self.get(), out))
    }

    fn frame(&mut self) {
        // SAFETY: the report is null.
        assert_eq!(unsafe { sorb_world_advance_frame(self.get_mut(), null_mut()) }, Status::Ok, "{}", last());
    }

    fn save(&self) -> Vec<u8> {
        // SAFETY: the buffer has room for its capacity.
        unsafe {
            let length = given(|out| sorb_world_save(self.get(), null_mut(), 0, out));
            let mut bytes = vec![0; length];
            given(|out| sorb_world_save(self.get(), bytes.as_mut_ptr(), length, out));
            bytes
        }
    }
}

impl Drop for Own {
    fn drop(&mut self) {
        // SAFETY: not freed yet.
        sorb_world_free(Some(unsafe { Box::from_raw(self.0) }));
    }
}

/// Checks a refusal and its text.
#[track_caller]
fn refused(status: Status, expected: Status, text: &str) {
    assert_eq!(status, expected, "{}", last());
    assert!(last().contains(text), "{}", last());
}
