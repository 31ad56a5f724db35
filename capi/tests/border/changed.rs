//! Bodies, sponges and flows that come, go and change.

use std::ptr::{null, null_mut};

use sorb_capi::*;

use crate::{Own, given, last, refused};

#[track_caller]
fn fine(status: Status) {
    assert_eq!(status, Status::Ok, "{}", last());
}

fn body(world: &Own, number: u32) -> Body {
    // SAFETY: numbers alone.
    let mut own: Body = unsafe { std::mem::zeroed() };
    own.size = size_of::<Body>();
    // SAFETY: `size` is that of the struct.
    fine(unsafe { sorb_world_body(world.get(), number, &raw mut own) });
    own
}

fn nodes(world: &Own) -> usize {
    // SAFETY: a null buffer asks for the length.
    unsafe {
        given(|out| sorb_world_copy(world.get(), Column::NodePositions as u32, null_mut(), 0, out)) / 12
    }
}

#[test]
fn bodies_come_change_and_go() {
    let mut world = Own::small();
    let json = c"{\"name\": \"other\", \"shape\": {\"kind\": \"sphere\", \"radius\": 0.01}, \"position\": [0.06, 0.2, 0.06]}";
    // SAFETY: texts end with a zero, and vectors have three numbers.
    unsafe {
        let other = given(|out| sorb_world_push_add_body(world.get_mut(), json.as_ptr(), out));
        assert_eq!(other, Handle { index: 1, generation: 0 });
        fine(sorb_world_push_body_kind(world.get_mut(), other, BodyKind::Kinematic as u32));
        fine(sorb_world_push_pose(
            world.get_mut(),
            other.index,
            [0.06, 0.15, 0.06].as_ptr(),
            null(),
            1.0 / 60.0,
        ));
        world.frame();
        assert!((body(&world, 1).position[1] - 0.15).abs() < 1e-5 && body(&world, 1).kind == 2);
        fine(sorb_world_push_remove_body(world.get_mut(), other));
        world.frame();
        // The number is taken again, by another body: the first handle is stale.
        let third = given(|out| sorb_world_push_add_body(world.get_mut(), json.as_ptr(), out));
        assert_eq!(third, Handle { index: 1, generation: 1 });
        world.frame();
        let digest = world.digest();
        refused(sorb_world_push_remove_body(world.get_mut(), other), Status::Command, "remove_body.body");
        refused(
            sorb_world_push_body_kind(world.get_mut(), third, 3),
            Status::NoSuchThing,
            "sorb_body_kind 3",
        );
        refused(
            sorb_world_push_add_body(world.get_mut(), c"{\"shap\": {}}".as_ptr(), None),
            Status::Command,
            "unknown field `shap`",
        );
        refused(
            sorb_world_push_add_body(world.get_mut(), json.as_ptr(), None),
            Status::NullPointer,
            "`body`",
        );
        assert_eq!(world.digest(), digest);
        fine(sorb_world_push_remove_body(world.get_mut(), third));
    }
}

#[test]
fn sponges_come_change_and_go() {
    let mut world = Own::small();
    let before = nodes(&world);
    let json =
        c"{\"name\": \"cube\", \"edge\": 0.015, \"cells\": [2, 2, 2], \"position\": [0.05, 0.1, 0.05]}";
    // SAFETY: texts end with a zero, and vectors have three numbers.
    unsafe {
        let cube = given(|out| sorb_world_push_add_sponge(world.get_mut(), json.as_ptr(), out));
        assert_eq!(cube, Handle { index: 1, generation: 0 });
        world.frame();
        assert_eq!(nodes(&world), before + 27);
        fine(sorb_world_push_material(world.get_mut(), cube, c"{\"young_modulus\": 5000}".as_ptr()));
        let up = [-0.06, 0.2, -0.06];
        fine(sorb_world_push_place_sponge(world.get_mut(), cube, up.as_ptr(), null(), null()));
        world.frame();
        let scene = given(|out| sorb_world_scene(world.get(), out));
        let length = given(|out| sorb_scene_to_json(Some(&*scene), null_mut(), 0, out));
        let mut json = vec![0_u8; length];
        given(|out| sorb_scene_to_json(Some(&*scene), json.as_mut_ptr(), length, out));
        sorb_scene_free(Some(Box::from_raw(scene)));
        assert!(String::from_utf8_lossy(&json).contains("5000"));
        for (json, text) in [
            (c"{\"young\": 1}", "young"),
            (c"{\"young_modulus\": -1}", "material.young_modulus"),
            (c"[]", "expected a map"),
        ] {
            refused(sorb_world_push_material(world.get_mut(), cube, json.as_ptr()), Status::Command, text);
        }
        let none = Handle { index: 7, generation: 0 };
        refused(
            sorb_world_push_material(world.get_mut(), none, c"{}".as_ptr()),
            Status::NoSuchThing,
            "no sponge 7",
        );
        let place = sorb_world_push_place_sponge(world.get_mut(), none, up.as_ptr(), null(), null());
        refused(place, Status::Command, "place_sponge.sponge");
        fine(sorb_world_push_remove_sponge(world.get_mut(), cube));
        world.frame();
    }
    assert_eq!(nodes(&world), before);
}

#[test]
fn flows_begin_and_end() {
    let mut world = Own::small();
    let tap = c"{\"position\": [0.06, 0.22, 0.06], \"velocity\": [0, -1, 0], \"radius\": 0.015}";
    let drain = c"{\"minimum\": [-0.085, 0, -0.085], \"maximum\": [0.085, 0.25, 0.085], \"rate\": 10}";
    let ledger = |world: &Own| {
        // SAFETY: numbers alone, and `size` is that of the struct.
        unsafe {
            let mut ledger: Ledger = std::mem::zeroed();
            ledger.size = size_of::<Ledger>();
            fine(sorb_world_ledger(world.get(), &raw mut ledger));
            ledger
        }
    };
    // SAFETY: texts end with a zero.
    unsafe {
        let first = given(|out| sorb_world_push_emit(world.get_mut(), tap.as_ptr(), out));
        for _ in 0..3 {
            world.frame();
        }
        let poured = ledger(&world).poured;
        assert!(poured > 0);
        fine(sorb_world_push_end_flow(world.get_mut(), first));
        let second = given(|out| sorb_world_push_drain(world.get_mut(), drain.as_ptr(), out));
        assert_eq!(second, first + 1);
        world.frame();
        assert!(ledger(&world).poured == poured && ledger(&world).drained > 0);
        refused(sorb_world_push_end_flow(world.get_mut(), first), Status::Command, "end_flow.number");
        refused(
            sorb_world_push_emit(world.get_mut(), c"{\"rate\": 1}".as_ptr(), None),
            Status::Command,
            "rate",
        );
        refused(sorb_world_push_drain(world.get_mut(), drain.as_ptr(), None), Status::NullPointer, "`flow`");
    }
}

#[test]
fn the_container_moves_on() {
    let mut world = Own::small();
    let digests: Vec<u64> = (0..2)
        .map(|round| {
            // SAFETY: texts end with a zero.
            unsafe {
                let mut world = Own(given(|out| sorb_world_clone(world.get(), out)));
                if round == 1 {
                    let motions =
                        c"[{\"kind\": \"linear\", \"velocity\": [0.2, 0, 0], \"start\": 0.0, \"end\": 0.1, \"ease\": 0.04}]";
                    fine(sorb_world_push_container(world.get_mut(), motions.as_ptr()));
                }
                world.frame();
                world.digest()
            }
        })
        .collect();
    assert_ne!(digests[0], digests[1]);
    // SAFETY: texts end with a zero.
    unsafe {
        refused(
            sorb_world_push_container(world.get_mut(), c"[]".as_ptr()),
            Status::Command,
            "container.motions",
        );
        refused(sorb_world_push_container(world.get_mut(), c"[{}]".as_ptr()), Status::Command, "kind");
    }
}
