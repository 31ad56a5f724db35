//! Saves that are truncated, altered, foreign or newer are errors that say which.

use proptest::prelude::*;
use sorb::{Options, Save, StateError, World};

use super::{busy, common, saved};

fn busy_world(name: &str) -> World {
    let mut world = common::world(&busy::scene(name, 0.4));
    common::steps(&mut world, 5);
    world
}

fn refused(bytes: &[u8]) -> StateError {
    match World::restore(bytes, &Options::default()) {
        Ok(_) => panic!("{} bytes were restored", bytes.len()),
        Err(error) => error,
    }
}

#[test]
fn what_is_wrong_with_a_file_is_said() {
    let world = busy_world("ball_drop");
    let good = saved(&world);
    assert!(World::restore(&good[..], &Options::default()).is_ok(), "the control");
    assert!(matches!(refused(b""), StateError::Truncated { .. }));
    assert!(matches!(refused(b"PNG or something else"), StateError::Kind { .. }));
    assert!(matches!(refused(&good[..good.len() - 1]), StateError::Truncated { what: "the body", .. }));
    let mut newer = good.clone();
    newer[8] += 1;
    let error = refused(&newer).to_string();
    assert_eq!(error, "version 2 of the format of a save; this library reads 1");
    let mut altered = good.clone();
    let middle = altered.len() / 2;
    altered[middle] ^= 1;
    assert!(matches!(refused(&altered), StateError::Altered { .. }));
    // A header that claims four gigabytes is refused for what is missing, not for want of memory.
    let mut huge = good.clone();
    huge[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(matches!(refused(&huge), StateError::Truncated { what: "the header", .. }));
}

#[test]
fn a_state_of_another_scene_is_refused() {
    let (mut ball, water) = (busy_world("ball_drop"), busy_world("water"));
    let other = water.to_save().unwrap_or_else(|error| panic!("{error}"));
    let before = ball.digest();
    let error = ball.resume(&other).map_err(|error| error.to_string());
    let expected = "it is a state of scene `water`, or of other keys, and the world is of scene `ball_drop`";
    assert_eq!(error, Err(expected.to_owned()));
    assert_eq!(ball.digest(), before, "nothing has changed");
}

#[test]
fn compressed_saves_are_smaller_and_the_same() {
    let world = busy_world("life");
    let save = world.to_save().unwrap_or_else(|error| panic!("{error}"));
    let (mut raw, mut packed) = (Vec::new(), Vec::new());
    save.write(&mut raw).unwrap_or_else(|error| panic!("{error}"));
    save.write_compressed(&mut packed).unwrap_or_else(|error| panic!("{error}"));
    assert!(packed.len() < raw.len() * 9 / 10, "{} of {} bytes", packed.len(), raw.len());
    let back = Save::read(&packed[..]).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(back.first_difference(&save), None);
    assert_eq!(saved(&back.world(&Options::default()).unwrap_or_else(|error| panic!("{error}"))), raw);
}

#[test]
fn one_bit_of_one_column_is_found_and_named() {
    let world = busy_world("ball_drop");
    let mut other = world.clone();
    other
        .push(sorb::Command::Velocity {
            body: 0.into(),
            linear_velocity: world.bodies()[0].state.linear_velocity.with_y(-0.123),
            angular_velocity: world.bodies()[0].state.angular_velocity,
        })
        .unwrap_or_else(|error| panic!("{error}"));
    let saves = |world: &World| world.to_save().unwrap_or_else(|error| panic!("{error}"));
    // A command that waits is part of the state.
    let found = saves(&world).first_difference(&saves(&other)).map(|difference| difference.column);
    assert_eq!(found.as_deref(), Some("rest"));
    assert_eq!(saves(&world).first_difference(&saves(&world.clone())), None, "the control");
    let mut world = world;
    common::steps(&mut world, 1);
    common::steps(&mut other, 1);
    let found = saves(&world).first_difference(&saves(&other)).unwrap_or_else(|| panic!("no difference"));
    assert!(found.row.is_some() && found.first != found.second, "{found}");
}

/// A small save of everything that there can be in one.
fn small() -> &'static [u8] {
    static SMALL: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    SMALL.get_or_init(|| {
        let mut world = common::world(&busy::scene("life", 0.3));
        common::steps(&mut world, 3);
        let mut bytes = Vec::new();
        let save = world.to_save().unwrap_or_else(|error| panic!("{error}"));
        save.write_compressed(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        bytes
    })
}

/// A save without bodies of rapier3d, whose own data are trusted as far as their checksum goes.
fn made_up() -> &'static [u8] {
    static MADE_UP: std::sync::OnceLock<Vec<u8>> = std::sync::OnceLock::new();
    MADE_UP.get_or_init(|| {
        let mut world = common::world(&busy::scene("wring", 0.3));
        common::steps(&mut world, 3);
        saved(&world)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn flipped_and_cut_bytes_are_errors(
        flips in prop::collection::vec((any::<prop::sample::Index>(), 1_u8..), 0..4),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = small().to_vec();
        for (index, flip) in &flips {
            let index = index.index(bytes.len());
            bytes[index] ^= flip;
        }
        if let Some(cut) = &cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        let is_whole = bytes == small();
        prop_assert_eq!(World::restore(&bytes[..], &Options::default()).is_ok(), is_whole);
    }

    #[test]
    fn what_is_made_up_with_a_right_checksum_is_an_error_or_a_state(
        flips in prop::collection::vec((any::<prop::sample::Index>(), 1_u8..), 1..4),
        in_header in any::<bool>(),
    ) {
        let mut bytes = made_up().to_vec();
        let header = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]) as usize;
        for (index, flip) in &flips {
            let index = if in_header { 24 + index.index(header) } else { 24 + index.index(bytes.len() - 24) };
            bytes[index] ^= flip;
        }
        let checksum = xxhash_rust::xxh3::xxh3_64(&bytes[24..]);
        bytes[16..24].copy_from_slice(&checksum.to_le_bytes());
        // Whatever it is, nothing panics, in the step after it neither.
        if let Ok(mut world) = World::restore(&bytes[..], &Options { threads: Some(1), ..Options::default() }) {
            let _ = world.step();
        }
    }
}
