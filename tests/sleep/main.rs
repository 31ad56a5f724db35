//! What comes to rest costs nothing until something comes near: whole scenes, and parts of them.

#[path = "../common/mod.rs"]
mod common;

mod parts;
mod whole;

use sorb::{World, glam::Vec3};

fn frame(world: &mut World) -> sorb::FrameReport {
    world.advance_frame().unwrap_or_else(|error| panic!("{}: {error}", world.scene().name))
}

/// Places of the particles, by identity.
fn positions(world: &World) -> Vec<Vec3> {
    let mut places = vec![Vec3::ZERO; world.particle_ids().len()];
    for (id, x) in world.particle_ids().iter().zip(world.particle_positions()) {
        places[*id as usize] = Vec3::new(x[0], x[1], x[2]);
    }
    places
}
