//! States of which parts sleep, with everything awake again later.

use sorb::{
    Options, World,
    glam::Vec3,
    scene::{Body, Fluid, FluidBlock, FluidSolver, Motion, Scene, ShapeKind, Sponge, Time},
};

use super::{common, restored, saved};

/// Shallow water with a sponge in it and a cube beside, and a plate that moves after three seconds.
fn pool() -> Scene {
    let half = Vec3::new(0.06, 0.0, 0.03);
    let blocks = vec![FluidBlock::new(-half, half + Vec3::Y * 0.03)];
    // The default solver goes on moving by some millimetres a second.
    let fluid = Fluid { spacing: 0.005, blocks, solver: Some(FluidSolver::Dfsph), ..Fluid::default() };
    let place = Vec3::new(0.01, 0.0, -0.015);
    let sponge = Sponge { cells: [3, 3, 3].into(), edge: 0.01, ..Sponge::new("sponge", place) };
    let cuboid = ShapeKind::Cuboid { half_extents: Vec3::new(0.005, 0.04, 0.04) };
    let motion = Motion::Linear { velocity: Vec3::X * 0.1, start: 3.0, end: 3.2, ease: 0.0 };
    let plate = Body::kinematic("plate", cuboid, Vec3::new(-0.07, 0.04, 0.0), vec![motion]);
    let cube = ShapeKind::Cuboid { half_extents: Vec3::splat(0.008) };
    let cube = Body::dynamic("cube", cube, Vec3::new(-0.03, 0.01, 0.0), 4000.0);
    let mut scene = Scene::new("pool")
        .in_box(-half - Vec3::X * 0.02, half + Vec3::new(0.02, 0.1, 0.0))
        .with_fluid(fluid)
        .with_sponge(sponge)
        .with_body(plate)
        .with_body(cube);
    scene.time = Time { sleep_after: 0.5, ..scene.time };
    scene
}

/// Frames until the plate has passed.
const FRAMES: u32 = 210;

#[test]
fn restores_while_parts_fall_asleep_sleep_and_wake() {
    let scene = pool();
    let mut straight = common::world(&scene);
    let mut world = common::world(&scene);
    let (mut slept, mut woke, mut kept) = (0, 0, 0);
    for frame in 0..FRAMES {
        common::frame(&mut straight);
        common::frame(&mut world);
        let bytes = saved(&straight);
        assert_eq!(saved(&world), bytes, "frame {frame}");
        slept += u32::from(world.is_asleep());
        woke += u32::from(slept > 0 && !world.is_asleep());
        if frame % 7 == 6 || world.is_fluid_asleep() && kept < 20 {
            kept += u32::from(world.is_fluid_asleep());
            let measures = world.measures();
            world =
                restored(&bytes, &Options { threads: Some(1 + frame as usize % 3), ..Options::default() });
            assert_eq!(world.measures(), measures, "frame {frame}: a picture of it would be another");
            assert_eq!(saved(&world), bytes, "frame {frame}: after a restore");
            assert_eq!(world.is_asleep(), straight.is_asleep());
        }
    }
    assert!(slept > 20 && woke > 5 && kept > 5, "slept {slept} frames, woke {woke}, restored asleep {kept}");
}

/// Every column that no state holds is overwritten with what is noticed, step by step.
#[test]
fn nothing_else_survives_a_step() {
    use sorb::internal::{column::Life, columns::Column, poison};
    let scratch = |column: &&Column| column.life() == Life::Scratch;
    for scene in [
        pool(),
        super::busy::scene("life", 0.4),
        super::busy::scene("life_divergence", 0.4),
        super::busy::scene("ball_drop_paper", 0.4),
    ] {
        let (mut straight, mut world) = (common::world(&scene), common::world(&scene));
        for frame in 0..if scene.name == "pool" { FRAMES } else { 6 } {
            common::frame(&mut straight);
            common::frame(&mut world);
            Column::ALL.iter().filter(scratch).for_each(|column| poison(&mut world, *column));
            assert_eq!(world.digest(), straight.digest(), "{}: frame {frame}", scene.name);
        }
        // The control: what a state holds may not be overwritten.
        poison(&mut world, Column::FluidVelocity);
        assert_ne!(world.digest(), straight.digest(), "{}", scene.name);
    }
    let poisoned = |world: &mut World| poison(world, Column::NodeVelocity);
    let mut world = common::world(&super::busy::scene("dry", 0.4));
    poisoned(&mut world);
    assert!(world.step().is_err(), "the control");
}
