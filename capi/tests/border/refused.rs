//! What is refused, and that it changes nothing.

use std::{
    ffi::c_char,
    mem::MaybeUninit,
    ptr::{null, null_mut},
};

use sorb_capi::*;

use crate::{BALL, Own, given, refused};

#[test]
fn null_pointers_are_named() {
    // SAFETY: null pointers are allowed everywhere.
    unsafe {
        refused(sorb_scene_preset(null(), Some(&mut MaybeUninit::uninit())), Status::NullPointer, "`name`");
        refused(sorb_scene_preset(c"dry".as_ptr(), None), Status::NullPointer, "`scene`");
        refused(sorb_world_new(None, null(), None), Status::NullPointer, "`scene`");
        refused(sorb_world_step(None, null_mut()), Status::NullPointer, "`world`");
        refused(sorb_world_advance_frame(None, null_mut()), Status::NullPointer, "`world`");
        refused(
            sorb_world_push(None, c"{\"end_flow\": {\"number\": 0}}".as_ptr()),
            Status::NullPointer,
            "`world`",
        );
        refused(sorb_world_digest(None, None), Status::NullPointer, "`world`");
        refused(sorb_world_rollback(None, None), Status::NullPointer, "`world`");
        let mut world = Own::small();
        let before = world.digest();
        refused(sorb_world_digest(world.get(), None), Status::NullPointer, "`digest`");
        refused(sorb_world_push(world.get_mut(), null()), Status::NullPointer, "`json`");
        refused(
            sorb_world_push_pose(world.get_mut(), 0, null(), null(), 1.0),
            Status::NullPointer,
            "`position`",
        );
        refused(sorb_world_clock(world.get(), null_mut()), Status::NullPointer, "sorb_clock");
        refused(sorb_world_view(world.get(), 0, null_mut()), Status::NullPointer, "sorb_view");
        refused(sorb_world_copy(world.get(), 0, null_mut(), 0, None), Status::NullPointer, "`length`");
        refused(sorb_world_cast_rays(world.get(), null(), 1, 7, null_mut()), Status::NullPointer, "`rays`");
        refused(
            sorb_world_probe(world.get(), [0.0; 3].as_ptr(), 1, null_mut()),
            Status::NullPointer,
            "`probes`",
        );
        refused(sorb_world_resume(world.get_mut(), null(), 8), Status::NullPointer, "`save`");
        assert_eq!(sorb_world_cast_rays(world.get(), null(), 0, 7, null_mut()), Status::Ok);
        assert_eq!(world.digest(), before);
        sorb_world_free(None);
        sorb_scene_free(None);
        sorb_snapshot_free(None);
    }
}

#[test]
fn texts_that_are_no_utf8_and_scenes_that_are_wrong_name_the_key() {
    let bad: [c_char; 3] = [b'a' as c_char, 0xff_u8 as c_char, 0];
    // SAFETY: all texts end with a zero.
    unsafe {
        refused(
            sorb_scene_preset(bad.as_ptr(), Some(&mut MaybeUninit::uninit())),
            Status::NotUtf8,
            "`name` is not UTF-8",
        );
        refused(
            sorb_scene_preset(c"bal_drop".as_ptr(), Some(&mut MaybeUninit::uninit())),
            Status::Scene,
            "ball_drop",
        );
        refused(
            sorb_scene_from_file(c"no.toml".as_ptr(), Some(&mut MaybeUninit::uninit())),
            Status::Scene,
            "no.toml: cannot read",
        );
        refused(
            sorb_scene_from_toml(
                c"version = 1\n[fluid]\nspacing = nan".as_ptr(),
                Some(&mut MaybeUninit::uninit()),
            ),
            Status::Scene,
            "fluid.spacing",
        );
        refused(
            sorb_scene_from_json(
                c"{\"version\": 1, \"fluids\": 1}".as_ptr(),
                Some(&mut MaybeUninit::uninit()),
            ),
            Status::Scene,
            "fluids",
        );
        let scene = given(|out| sorb_scene_preset(c"dry".as_ptr(), out));
        refused(
            sorb_scene_set(Some(&mut *scene), c"sponges.sponge.edge=nan".as_ptr()),
            Status::Scene,
            "sponges[0].edge",
        );
        refused(sorb_scene_scale(Some(&mut *scene), f32::NAN), Status::Scene, "resolution");
        let mut options =
            Options { size: size_of::<Options>(), threads: 0, simd: c"mmx".as_ptr(), backend: null() };
        refused(
            sorb_world_new(Some(&*scene), &raw const options, Some(&mut MaybeUninit::uninit())),
            Status::World,
            "options.simd = \"mmx\"",
        );
        options.simd = null();
        options.backend = c"cloud".as_ptr();
        refused(
            sorb_world_new(Some(&*scene), &raw const options, Some(&mut MaybeUninit::uninit())),
            Status::World,
            "cloud",
        );
        options.backend = null();
        options.threads = 5000;
        refused(
            sorb_world_new(Some(&*scene), &raw const options, Some(&mut MaybeUninit::uninit())),
            Status::World,
            "5000",
        );
        options.size = 3;
        refused(
            sorb_world_new(Some(&*scene), &raw const options, Some(&mut MaybeUninit::uninit())),
            Status::BadSize,
            "sorb_options.size = 3",
        );
        sorb_scene_free(Some(Box::from_raw(scene)));
    }
}

#[test]
fn buffers_that_are_too_small_stay_as_they_are() {
    let world = Own::small();
    // SAFETY: every buffer has room for its capacity.
    unsafe {
        let length =
            given(|out| sorb_world_copy(world.get(), Column::ParticlePositions as u32, null_mut(), 0, out));
        let mut buffer = vec![7.0_f32; length / 4];
        let mut needed = MaybeUninit::new(0);
        let to = buffer.as_mut_ptr().cast();
        let status =
            sorb_world_copy(world.get(), Column::ParticlePositions as u32, to, length - 1, Some(&mut needed));
        refused(status, Status::BufferTooSmall, &format!("needs {length}"));
        assert_eq!(needed.assume_init(), length);
        assert!(buffer.iter().all(|value| *value == 7.0));
        let to = buffer.as_mut_ptr().cast();
        given(|out| sorb_world_copy(world.get(), Column::ParticlePositions as u32, to, length, out));
        let mut view = View {
            size: size_of::<View>(),
            data: null(),
            rows: 0,
            stride: 0,
            components: 0,
            element_type: 9,
        };
        assert_eq!(sorb_world_view(world.get(), Column::ParticlePositions as u32, &raw mut view), Status::Ok);
        assert_eq!((view.rows, view.stride, view.components, view.element_type), (length / 12, 16, 3, 0));
        for row in 0..view.rows {
            let seen = view.data.byte_add(row * view.stride).cast::<[f32; 3]>().read();
            assert_eq!(seen[..], buffer[3 * row..3 * row + 3]);
        }
        refused(
            sorb_world_view(world.get(), Column::NodeMasses as u32, &raw mut view),
            Status::NoSuchThing,
            "copy it",
        );
        refused(
            sorb_world_view(world.get(), 99, &raw mut view),
            Status::NoSuchThing,
            "column 99 is out of range 0 to 10",
        );
        view.size = 1000;
        refused(sorb_world_view(world.get(), 0, &raw mut view), Status::BadSize, "sorb_view.size = 1000");
        let mut small = [1_u8; 4];
        let status = sorb_world_save(world.get(), small.as_mut_ptr(), 4, Some(&mut MaybeUninit::uninit()));
        refused(status, Status::BufferTooSmall, "`buffer` has 4 bytes");
        assert_eq!(small, [1; 4]);
        let huge = usize::MAX / 2;
        refused(
            sorb_world_probe(world.get(), [0.0; 3].as_ptr(), huge, null_mut()),
            Status::BadSize,
            "`points`",
        );
    }
}

#[test]
fn commands_out_of_range_change_nothing() {
    let mut world = Own::small();
    let before = world.digest();
    let (zero, nan) = ([0.0_f32; 3], [0.0_f32, f32::NAN, 0.0]);
    // SAFETY: every array has three numbers, and texts end with a zero.
    unsafe {
        refused(
            sorb_world_push_impulse(world.get_mut(), BALL, nan.as_ptr(), zero.as_ptr()),
            Status::Command,
            "impulse.impulse",
        );
        refused(
            sorb_world_push_force(world.get_mut(), 9, zero.as_ptr(), zero.as_ptr()),
            Status::Command,
            "force.body",
        );
        refused(
            sorb_world_push_velocity(world.get_mut(), BALL, [1e9, 0.0, 0.0].as_ptr(), zero.as_ptr()),
            Status::Command,
            "velocity.linear_velocity",
        );
        refused(sorb_world_push_gravity(world.get_mut(), nan.as_ptr()), Status::Command, "gravity.gravity");
        refused(
            sorb_world_push_pose(world.get_mut(), BALL, nan.as_ptr(), null(), 1.0),
            Status::Command,
            "pose.position",
        );
        refused(
            sorb_world_push_pour(world.get_mut(), zero.as_ptr(), nan.as_ptr(), null()),
            Status::Command,
            "pour.region",
        );
        for (json, text) in [
            (c"{", "command: EOF"),
            (c"{\"jump\": {}}", "jump"),
            (c"{\"gravity\": {\"gravity\": [0, 1]}}", "command:"),
            (c"{\"gravity\": {\"gravity\": [0, 1e39, 0]}}", "command:"),
            (c"{\"gravity\": {\"gravity\": [0, 200, 0]}}", "out of range -100 to 100"),
        ] {
            refused(sorb_world_push(world.get_mut(), json.as_ptr()), Status::Command, text);
        }
        let mut body = MaybeUninit::uninit();
        refused(
            sorb_world_find_body(world.get(), c"bal".as_ptr(), Some(&mut body)),
            Status::NoSuchThing,
            "bodies: ball",
        );
        let mut own: Body = std::mem::zeroed();
        own.size = size_of::<Body>();
        refused(sorb_world_body(world.get(), 9, &raw mut own), Status::NoSuchThing, "body 9");
        let mut levels = [0.0; 1];
        refused(
            sorb_world_water_levels(world.get(), nan.as_ptr(), 1, levels.as_mut_ptr()),
            Status::Query,
            "query 0: point",
        );
        let mut hit = Hit::default();
        let ray = Ray { origin: [0.0; 3], direction: [0.0; 3], length: 1.0 };
        refused(
            sorb_world_cast_rays(world.get(), &raw const ray, 1, 7, &raw mut hit),
            Status::Query,
            "direction",
        );
        refused(
            sorb_world_cast_rays(world.get(), &raw const ray, 1, 8, &raw mut hit),
            Status::NoSuchThing,
            "targets = 8",
        );
    }
    assert_eq!(world.digest(), before);
    world.frame();
    assert_ne!(world.digest(), before);
}
