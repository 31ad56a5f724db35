//! The same bits after any interruption: saves, restores, commands, recordings and roll backs.

/// Hands all scenes of the library, busy, and others with other solvers to a macro.
macro_rules! for_every_scene {
    ($macro:ident) => {
        sorb::for_every_preset! { $macro ball_drop_paper dry_paper life_pbf life_divergence ball_drop_smoothed ball_drop_divergence }
    };
}

mod asleep;
mod commands;
#[path = "../common/mod.rs"]
mod common;
mod damage;
mod matrix;
mod recordings;
mod rollback;
mod size;

use common::busy;
use sorb::{Options, SimdLevel, World, scene::Scene};

/// More than one chunk of nodes and several chunks of particles, so that threads matter.
const RESOLUTION: f32 = 0.6;

fn options(threads: usize, simd: SimdLevel) -> Options {
    Options { threads: Some(threads), simd: Some(simd), ..Options::default() }
}

fn world_on(scene: &Scene, threads: usize, simd: SimdLevel) -> World {
    World::with_options(scene, &options(threads, simd))
        .unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

fn saved(world: &World) -> Vec<u8> {
    let mut bytes = Vec::new();
    world.save(&mut bytes).unwrap_or_else(|error| panic!("{}: {error}", world.scene().name));
    bytes
}

fn restored(bytes: &[u8], options: &Options) -> World {
    World::restore(bytes, options).unwrap_or_else(|error| panic!("{error}"))
}

/// The levels of the matrix that this machine has.
fn levels() -> Vec<SimdLevel> {
    let mut levels = vec![SimdLevel::Fallback, SimdLevel::Sse42, SimdLevel::Avx2, SimdLevel::best()];
    levels.dedup();
    levels.retain(|level| level.is_supported());
    levels
}
