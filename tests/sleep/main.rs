//! Sleep: parts at rest cost nothing until something comes near, in whole scenes and in parts of them.

#[path = "../common/mod.rs"]
mod common;

mod parts;
mod whole;

use sorb::World;

fn frame(world: &mut World) -> sorb::FrameReport {
    world.advance_frame().unwrap_or_else(|error| panic!("{}: {error}", world.scene().name))
}
