//! What comes to rest costs nothing until something comes near: whole scenes, and parts of them.

#[path = "../common/mod.rs"]
mod common;

mod parts;
mod whole;

use sorb::World;

fn frame(world: &mut World) -> sorb::FrameReport {
    world.advance_frame().unwrap_or_else(|error| panic!("{}: {error}", world.scene().name))
}
