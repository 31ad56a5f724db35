//! What a host does.

use std::{
    ffi::CString,
    mem::MaybeUninit,
    ptr::{null, null_mut},
};

use sorb_capi::*;

use crate::{BALL, Own, given, last, refused};

#[test]
fn every_column_has_rows_of_its_width() {
    let world = Own::small();
    for column in 0..=Column::Triangles as u32 {
        let wide = matches!(column, 0 | 1 | 5 | 6 | 10);
        // SAFETY: a null buffer asks for the length.
        let length = unsafe { given(|out| sorb_world_copy(world.get(), column, null_mut(), 0, out)) };
        assert!(length > 0 && length % if wide { 12 } else { 4 } == 0, "{column} {length}");
    }
}

#[test]
fn commands_move_what_they_say_and_questions_see_it() {
    let mut world = Own::small();
    // SAFETY: every array has three numbers, and texts end with a zero.
    unsafe {
        let body = given(|out| sorb_world_find_body(world.get(), c"ball".as_ptr(), out));
        let push =
            sorb_world_push_velocity(world.get_mut(), body, [0.0, 1.0, 0.0].as_ptr(), [0.0; 3].as_ptr());
        assert_eq!(push, Status::Ok, "{}", last());
        let json = c"{\"gravity\": {\"gravity\": [0, 0, 0]}}";
        assert_eq!(sorb_world_push(world.get_mut(), json.as_ptr()), Status::Ok, "{}", last());
        let mut own: Body = std::mem::zeroed();
        own.size = size_of::<Body>();
        assert_eq!(sorb_world_body(world.get(), body, &raw mut own), Status::Ok, "{}", last());
        let before = own.position[1];
        world.frame();
        assert_eq!(sorb_world_body(world.get(), body, &raw mut own), Status::Ok, "{}", last());
        assert!((own.position[1] - before - 1.0 / 60.0).abs() < 1e-4, "{own:?}");
        let ray = Ray { origin: [0.0, 0.24, 0.0], direction: [0.0, -1.0, 0.0], length: 1.0 };
        let mut hit = Hit::default();
        assert_eq!(
            sorb_world_cast_rays(world.get(), &raw const ray, 1, 7, &raw mut hit),
            Status::Ok,
            "{}",
            last()
        );
        assert_eq!((hit.surface, hit.number), (Surface::Body as u32, body));
        let mut probe = Probe::default();
        assert_eq!(
            sorb_world_probe(world.get(), [0.0, 0.02, 0.0].as_ptr(), 1, &raw mut probe),
            Status::Ok,
            "{}",
            last()
        );
        assert!(probe.sponge == 0 && probe.saturation > 0.5, "{probe:?}");
        let (low, high) = ([-0.08, 0.1, -0.08], [-0.06, 0.12, -0.06]);
        let poured = sorb_world_push_pour(world.get_mut(), low.as_ptr(), high.as_ptr(), null());
        assert_eq!(poured, Status::Ok, "{}", last());
        world.frame();
        let mut ledger: Ledger = std::mem::zeroed();
        ledger.size = size_of::<Ledger>();
        assert_eq!(sorb_world_ledger(world.get(), &raw mut ledger), Status::Ok, "{}", last());
        assert!(ledger.poured > 0 && ledger.lost == 0, "{ledger:?}");
    }
}

#[test]
fn states_come_back_and_damaged_ones_are_refused() {
    let mut world = Own::small();
    world.frame();
    let (save, digest) = (world.save(), world.digest());
    // SAFETY: lengths are those of the buffers.
    unsafe {
        let restored = Own(given(|out| sorb_world_restore(save.as_ptr(), save.len(), null(), out)));
        assert_eq!(restored.digest(), digest);
        let copy = Own(given(|out| sorb_world_clone(world.get(), out)));
        assert_eq!(copy.digest(), digest);
        let snapshot = given(|out| sorb_snapshot_new(out));
        refused(sorb_world_rollback(world.get_mut(), Some(&*snapshot)), Status::State, "");
        assert_eq!(sorb_world_snapshot(world.get(), Some(&mut *snapshot)), Status::Ok);
        world.frame();
        assert_ne!(world.digest(), digest);
        assert_eq!(sorb_world_rollback(world.get_mut(), Some(&*snapshot)), Status::Ok, "{}", last());
        assert_eq!(world.digest(), digest);
        sorb_snapshot_free(Some(Box::from_raw(snapshot)));
        world.frame();
        let later = world.digest();
        for length in [0, 7, save.len() - 1] {
            refused(sorb_world_resume(world.get_mut(), save.as_ptr(), length), Status::State, "");
        }
        let mut damaged = save.clone();
        damaged[save.len() / 2] ^= 1;
        refused(sorb_world_resume(world.get_mut(), damaged.as_ptr(), damaged.len()), Status::State, "");
        assert_eq!(world.digest(), later);
        assert_eq!(sorb_world_resume(world.get_mut(), save.as_ptr(), save.len()), Status::Ok, "{}", last());
    }
    assert_eq!(world.digest(), digest);
}

#[test]
fn a_recording_is_played_to_the_same_digests() {
    let mut world = Own::small();
    // SAFETY: lengths are those of the buffers.
    unsafe {
        let mut length = MaybeUninit::uninit();
        refused(
            sorb_world_recording(world.get(), null_mut(), 0, Some(&mut length)),
            Status::Recording,
            "not being recorded",
        );
        refused(sorb_world_end_recording(world.get_mut()), Status::Recording, "not being recorded");
        assert_eq!(sorb_world_record(world.get_mut(), 2), Status::Ok, "{}", last());
        refused(sorb_world_record(world.get_mut(), 2), Status::Recording, "already");
        let up = [0.0, 0.5, 0.0];
        assert_eq!(
            sorb_world_push_impulse(world.get_mut(), BALL, up.as_ptr(), [0.0; 3].as_ptr()),
            Status::Ok
        );
        world.frame();
        assert_eq!(sorb_world_step(world.get_mut(), null_mut()), Status::Ok);
        world.frame();
        let save = world.save();
        refused(
            sorb_world_resume(world.get_mut(), save.as_ptr(), save.len()),
            Status::Recording,
            "end the recording",
        );
        let length = given(|out| sorb_world_recording(world.get(), null_mut(), 0, out));
        let mut bytes = vec![0_u8; length];
        given(|out| sorb_world_recording(world.get(), bytes.as_mut_ptr(), length, out));
        assert_eq!(sorb_world_end_recording(world.get_mut()), Status::Ok, "{}", last());
        let ticks = given(|out| sorb_recording_verify(bytes.as_ptr(), length, null(), out));
        assert_eq!(ticks, 3);
        bytes[length / 2] ^= 1;
        refused(sorb_recording_verify(bytes.as_ptr(), length, null(), None), Status::Recording, "");
    }
}

#[test]
fn a_scene_as_json_is_read_back() {
    let world = Own::small();
    // SAFETY: lengths are those of the buffers.
    unsafe {
        let scene = given(|out| sorb_world_scene(world.get(), out));
        let length = given(|out| sorb_scene_to_json(Some(&*scene), null_mut(), 0, out));
        let mut json = vec![0_u8; length];
        given(|out| sorb_scene_to_json(Some(&*scene), json.as_mut_ptr(), length, out));
        let json = CString::new(json).expect("no zeros");
        let again = given(|out| sorb_scene_from_json(json.as_ptr(), out));
        let copy = Own(given(|out| sorb_world_new(Some(&*again), null(), out)));
        assert_eq!(copy.digest(), world.digest());
        sorb_scene_free(Some(Box::from_raw(scene)));
        sorb_scene_free(Some(Box::from_raw(again)));
    }
}
