//! Worlds on the best adapter of the machine, for benches.

#![allow(dead_code, reason = "every bench uses a part of it")]

use std::sync::Arc;

use sorb::{Offload, Options, World, gpu::Gpu, scene::Scene};

/// The best adapter, printed on standard output: a row of results names it.
#[expect(clippy::print_stdout, reason = "a figure without its adapter and driver says nothing")]
pub(crate) fn adapter() -> Option<Arc<Gpu>> {
    match Gpu::new() {
        Ok(gpu) => {
            println!("adapter: {}, driver: {}", gpu.report().name, gpu.report().driver);
            Some(Arc::new(gpu))
        }
        Err(error) => {
            println!("SKIPPED on a GPU: {error}");
            None
        }
    }
}

/// A world on it, in motion.
pub(crate) fn world(scene: &Scene, gpu: &Arc<Gpu>, gpu_times: bool) -> World {
    let options =
        Options { offload: Offload::Gpu, gpu: Some(Arc::clone(gpu)), gpu_times, ..Options::default() };
    let run = || {
        let mut world = World::with_options(scene, &options).expect("a preset is valid");
        for _ in 0..5 {
            world.step().expect("a preset is stable");
        }
        world
    };
    let world = run();
    // The timed work must be the same every time, to the bit.
    assert_eq!(world.digest(), run().digest(), "two runs differ");
    world
}
