//! State on a device: lost, moved elsewhere, measured there, and requested.

use std::sync::Arc;

use sorb::{
    Offload, Options, StepError, World,
    gpu::{Gpu, GpuError},
    internal::{
        self,
        columns::{Column, Columns},
    },
    scene::Scene,
};

use super::{busy, common, difference, gpu, new_gpu, world};

/// A separate device, which can be lost without the others.
fn another_gpu() -> Arc<Gpu> {
    Arc::new(new_gpu())
}

fn world_on(scene: &Scene, gpu: &Arc<Gpu>) -> World {
    let options = Options { offload: Offload::Gpu, gpu: Some(Arc::clone(gpu)), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// Steps until the loss of the device shows.
fn lose(world: &mut World, gpu: &Gpu) {
    gpu.device().destroy();
    let error = world.advance_frame().map(|_| ());
    assert!(matches!(error, Err(StepError::Gpu(GpuError::Lost { .. }))), "{error:?}");
    assert_eq!(world.advance_frame().map(|_| ()), error, "a world without a device stays where it is");
}

#[test]
fn a_lost_device_costs_what_was_not_looked_at() {
    for name in ["water", "ball_drop"] {
        let scene = busy::scene(name, 0.3);
        let lost = another_gpu();
        let (mut world, mut never_lost) = (world_on(&scene, &lost), world_on(&scene, &gpu()));
        for _ in 0..2 {
            common::frame(&mut world);
            common::frame(&mut never_lost);
        }
        assert_eq!(world.state_digest(), never_lost.state_digest(), "{name}");
        let (digest, clock) = (world.state_digest(), *world.clock());
        common::frame(&mut world);
        lose(&mut world, &lost);
        let on_cpu = {
            let mut world = world.clone();
            world.move_to(None).unwrap_or_else(|error| panic!("{name}: {error}"));
            world
        };
        world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{name}: {error}"));
        for (mut world, bound) in [(world, 0.0), (on_cpu, 1e-3)] {
            assert_eq!((world.state_digest(), *world.clock()), (digest, clock), "{name}");
            let mut never_lost = never_lost.clone();
            for _ in 0..2 {
                common::frame(&mut world);
                common::frame(&mut never_lost);
            }
            let (found, what) = difference(&never_lost.measures(), &world.measures());
            assert!(found <= bound, "{name}: {what} differs by {found:.1e}");
            assert_eq!(world.state_digest() == never_lost.state_digest(), bound == 0.0, "{name}");
        }
    }
}

#[test]
fn a_device_that_is_lost_before_anyone_looked_costs_everything() {
    let scene = busy::scene("ball_drop", 0.5);
    let lost = another_gpu();
    let mut world = world_on(&scene, &lost);
    let first = world.state_digest();
    common::frame(&mut world);
    lose(&mut world, &lost);
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((world.state_digest(), world.clock().time), (first, 0.0));
    let mut again = world_on(&scene, &gpu());
    common::frame(&mut world);
    common::frame(&mut again);
    assert_eq!(world.state_digest(), again.state_digest());
}

#[test]
fn a_world_can_leave_a_device_that_works() {
    let scene = busy::scene("ball_drop", 0.5);
    let mut world = world_on(&scene, &gpu());
    common::frame(&mut world);
    let mut copy = world.clone();
    let digest = copy.state_digest();
    world.move_to(None).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.gpu().is_none() && world.plan().placement().is_none());
    assert_eq!(world.state_digest(), digest);
    common::frame(&mut world);
    world.move_to(Some(&gpu())).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.gpu().is_some());
    common::frame(&mut world);
    common::frame(&mut copy);
    common::frame(&mut copy);
    let (found, what) = difference(&copy.measures(), &world.measures());
    assert!(found < 1e-3, "{what} differs by {found:.1e}");
}

#[test]
fn measures_are_the_same_without_reading_the_state_back() {
    for name in ["water_paper", "ball_drop_paper", "dry", "dam_break_paper"] {
        let scene = busy::scene(name, 0.3);
        let mut world = world_on(&scene, &gpu());
        common::frame(&mut world);
        let on_device = world.measures();
        assert_eq!(world.measures(), on_device, "{name}: sums are taken in a fixed order");
        // Reads the state back, so that it is measured on the host from now on.
        let _ = world.particle_positions();
        let on_host = world.measures();
        assert_ne!(on_device, on_host, "{name}: the device was not asked");
        let (found, what) = difference(&on_host, &on_device);
        // The elastic energy of small strain is the difference of sums that are a hundred times as large.
        assert!(found < 2e-6, "{name}: {what} differs by {found:.1e}");
        let apart = |a: f64, b: f64| (a - b).abs() / (a.abs() + 1e-9);
        for (what, a, b) in [
            ("wicking height", on_host.wicking_height, on_device.wicking_height),
            ("maximum speed", on_host.maximum_speed, on_device.maximum_speed),
            ("maximum density error", on_host.maximum_density_error, on_device.maximum_density_error),
            ("angular momentum", on_host.angular_momentum.length(), on_device.angular_momentum.length()),
        ] {
            assert!(apart(a, b) < 1e-4, "{name}: {what} is {a:e} and {b:e}");
        }
        // Negative control: a step more is another state.
        let mut later = world.clone();
        common::steps(&mut later, 1);
        assert!(difference(&on_host, &later.measures()).0 > 1e-6, "{name}");
    }
}

#[test]
fn a_state_that_was_asked_for_is_the_one_at_that_time() {
    let scene = busy::scene("ball_drop", 0.5);
    for offload in [Offload::Gpu, Offload::Cpu] {
        let mut world = world(&scene, offload.clone());
        common::frame(&mut world);
        let mut then = world.clone();
        let mut request = world.request_state().unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut world);
        // The device has answered: it worked on the next frame meanwhile.
        assert!(request.is_ready(), "{offload}");
        assert_eq!(request.clock(), then.clock());
        let found = request.take().unwrap_or_else(|error| panic!("{error}"));
        for column in [Column::FluidPosition, Column::FluidId, Column::NodeVelocity, Column::NodeSaturation] {
            let words = |columns: &Columns| {
                let mut words = Vec::new();
                let rows = columns.rows.of(column.store());
                columns.data(column).visit_words(rows, &mut |word| words.push(word));
                words
            };
            assert!(
                words(internal::state_columns(&found)) == words(internal::columns(&then)),
                "{offload}: {}",
                column.name()
            );
            let is_state = column != Column::FluidId;
            assert!(
                !is_state || words(internal::state_columns(&found)) != words(internal::columns(&world)),
                "{offload}: {}",
                column.name()
            );
        }
        common::frame(&mut then);
        // Taking a request at once waits, and dropping one does no harm.
        drop(world.request_state());
        let waited = world.request_state().and_then(|request| request.take());
        assert!(waited.is_ok_and(|state| state.particle_positions() == world.particle_positions()));
    }
}
