//! Errors of worlds that cannot be built, and of steps that cannot be taken.

mod common;

use common::busy;
use sorb::{
    Bound, CpuError, Options, SimdLevel, StepError, World, WorldError,
    glam::Vec3,
    scene::{Body, Scene, ShapeKind},
};

fn refused(scene: &Scene, options: &Options) -> WorldError {
    match World::with_options(scene, options) {
        Ok(_) => panic!("{} must be refused", scene.name),
        Err(error) => error,
    }
}

#[test]
fn numbers_of_threads_out_of_range_are_named() {
    let scene = Scene::new("nothing");
    for threads in [0, 1025] {
        let error = refused(&scene, &Options { threads: Some(threads), ..Options::default() });
        assert!(
            matches!(error, WorldError::Cpu(CpuError::Threads { threads: asked, .. }) if asked == threads)
        );
        let text = error.to_string();
        assert!(text.contains(&threads.to_string()) && text.contains("1 to 1024"), "{text}");
    }
    assert!(World::with_options(&scene, &Options { threads: Some(1), ..Options::default() }).is_ok());
}

#[test]
fn simd_levels_that_the_machine_lacks_are_named() {
    let scene = Scene::new("nothing");
    for level in SimdLevel::ALL {
        let options = Options { simd: Some(level), ..Options::default() };
        if level.is_supported() {
            assert!(World::with_options(&scene, &options).is_ok(), "{level}");
            continue;
        }
        let error = refused(&scene, &options);
        assert!(
            matches!(error, WorldError::Cpu(CpuError::UnsupportedLevel { level: asked, .. }) if asked == level)
        );
        let text = error.to_string();
        assert!(text.contains(level.name()) && text.contains("fallback"), "{text}");
    }
}

#[test]
fn values_out_of_range_are_refused_with_their_key() {
    let mut scene = common::preset("standing", 0.5);
    scene.sponges[0].porosity = 1.5;
    let error = refused(&scene, &Options::default());
    assert!(matches!(error, WorldError::Scene(_)), "{error:?}");
    assert!(error.to_string().contains("sponges[0].porosity"), "{error}");
    scene.sponges[0].porosity = f32::NAN;
    assert!(refused(&scene, &Options::default()).to_string().contains("sponges[0].porosity"));
}

#[test]
fn a_hull_without_volume_is_refused_with_its_key() {
    let point = |x: f32, z: f32| Vec3::new(x, 0.0, z);
    let vertices = vec![point(0.0, 0.0), point(1.0, 0.0), point(0.0, 1.0), point(1.0, 1.0)];
    let body = Body::dynamic("plate", ShapeKind::Hull { vertices }, Vec3::ZERO, 1000.0);
    let error = refused(&Scene::new("flat").with_body(body), &Options::default());
    assert!(error.to_string().contains("bodies[0].shape.vertices"), "{error}");
}

#[test]
fn a_step_below_the_minimum_is_refused_and_stays_refused() {
    let keys = ["fluid.solver=wcsph", "time.minimum_step=0.002", "time.maximum_step=0.002"];
    let scene = common::with(&busy::scene("water", 0.5), &keys);
    let mut world = common::world(&scene);
    let before = world.digest();
    let error = world.step().expect_err("the speed of sound asks for less");
    let StepError::TooSmall { bound, needed, minimum, step, time } = error.clone() else {
        panic!("{error}");
    };
    assert_eq!((bound, step, time), (Bound::Courant, 0, 0.0));
    assert!(needed > 0.0 && needed < minimum && minimum == 0.002, "{error}");
    let text = error.to_string();
    assert!(text.contains("`courant`") && text.contains("time.minimum_step"), "{text}");
    assert_eq!(world.digest(), before, "nothing has moved");
    assert_eq!(world.step(), Err(error.clone()));
    assert_eq!(world.advance_frame().map(|_| ()), Err(error.clone()));
    assert_eq!(world.clone().step(), Err(error), "a copy of a failed world has failed, too");
    // Negative control: the same scene with room below.
    let scene = common::with(&scene, &["time.minimum_step=1e-6"]);
    assert!(common::world(&scene).step().is_ok());
}

#[test]
fn the_end_of_a_frame_may_need_a_shorter_step_than_the_minimum() {
    // 60 frames per second are no multiple of the step by elasticity: the equal steps of a frame are below the minimum, and
    // still taken.
    let scene = common::preset("dry", 0.5);
    let whole = common::world(&scene).step().unwrap_or_else(|error| panic!("{error}")).step;
    let scene = common::with(&scene, &[&format!("time.minimum_step={}", 0.99 * whole)]);
    let mut world = common::world(&scene);
    let report = world.advance_frame().unwrap_or_else(|error| panic!("{error}"));
    assert!(report.shortest_step < 0.99 * whole, "{report:?}");
    assert!((report.time - 1.0 / 60.0).abs() < 1e-9, "{report:?}");
}
