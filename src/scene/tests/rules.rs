use glam::{UVec3, Vec3};

use super::super::*;
use super::{full, only};

/// Changes the full scene and returns the text of its only problem.
fn broken(change: impl FnOnce(&mut Scene)) -> String {
    let mut scene = full();
    change(&mut scene);
    only(&scene).to_string()
}

fn fluid(scene: &mut Scene) -> &mut Fluid {
    scene.fluid.as_mut().expect("the full scene has a fluid")
}

#[test]
fn the_unbroken_scenes_are_valid() {
    assert_eq!(full().problems(), []);
    assert_eq!(Scene::default().problems(), []);
    full().validate().expect("no problems");
}

#[test]
fn every_number_is_checked_at_both_ends_and_for_nan() {
    for (value, text) in [(9e-15, "9e-15"), (1.1e-5, "1.1e-5"), (f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
        let message = broken(|scene| scene.sponges[0].permeability = value);
        assert_eq!(message, format!("`sponges[0].permeability` = {text} is out of range 1e-14 to 1e-5 m^2"));
    }
    for end in [1e-14, 1e-5] {
        let mut scene = full();
        scene.sponges[0].permeability = end;
        assert_eq!(scene.problems(), [], "the ends belong to the range");
    }
    let message = broken(|scene| scene.gravity.y = f32::NEG_INFINITY);
    assert_eq!(message, "`gravity[1]` = -inf is out of range -100 to 100 m/s^2");
    let message = broken(|scene| scene.sponges[0].cells = UVec3::new(8, 1, 8));
    assert_eq!(message, "`sponges[0].cells[1]` = 1 is out of range 2 to 1024");
    let message = broken(|scene| {
        scene.bodies[0].shape =
            ShapeKind::Hull { vertices: vec![Vec3::ZERO, Vec3::X, Vec3::new(0.0, f32::NAN, 0.0), Vec3::Z] };
    });
    assert_eq!(message, "`bodies[0].shape.vertices[2][1]` = NaN is out of range -100 to 100 m");
}

#[test]
fn all_range_problems_are_reported_together() {
    let mut scene = full();
    scene.time.courant = 0.0;
    fluid(&mut scene).support = 5.0;
    scene.bodies[0].friction = -1.0;
    let keys: Vec<String> = scene.problems().into_iter().map(|problem| problem.key).collect();
    assert_eq!(keys, ["time.courant", "fluid.support", "bodies[0].friction"]);
    let text = scene.validate().expect_err("three problems").to_string();
    assert_eq!(text.lines().count(), 3);
    assert!(text.lines().all(|line| line.starts_with("scene full: ")), "{text}");
}

#[test]
fn corners_are_ordered_and_inside() {
    let message = broken(|scene| fluid(scene).blocks[0].minimum.z = 0.1);
    assert!(message.starts_with("`fluid.blocks[0].minimum` = [-0.1, 0, 0.1]: must be below"), "{message}");
    let message = broken(|scene| fluid(scene).blocks[0].maximum.x = 0.11);
    assert!(message.contains("must be inside the container [-0.1, 0, -0.1] to [0.1, 0.2, 0.1]"), "{message}");
    let message = broken(|scene| scene.sponges[0].position.x = 0.03);
    assert!(message.starts_with("`sponges[0]` = (from [0.03"), "{message}");
    let message = broken(|scene| scene.bodies[0].position.y = 0.3);
    assert!(message.starts_with("`bodies[0].position`"), "{message}");
    let empty = Scene::new("flat").in_box(Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0));
    assert_eq!(only(&empty).key, "domain.minimum");
}

#[test]
fn overlaps_are_refused_and_contact_is_not() {
    let block = FluidBlock::new(Vec3::new(-0.1, 0.02, -0.1), Vec3::new(0.1, 0.05, 0.1));
    let message = broken(|scene| fluid(scene).blocks.push(block));
    assert!(message.contains("overlaps `fluid.blocks[0]`"), "{message}");
    let message = broken(|scene| scene.sponges.push(Sponge::new("other", Vec3::new(0.0, 0.07, 0.0))));
    assert!(message.contains("overlaps `sponges[0]`"), "{message}");
    let mut scene = full();
    let above = FluidBlock::new(Vec3::new(-0.1, 0.03, -0.1), Vec3::new(0.1, 0.05, 0.1));
    fluid(&mut scene).blocks.push(above);
    scene.sponges.push(Sponge::new("other", Vec3::new(0.0, 0.08, 0.0)));
    assert_eq!(scene.problems(), []);
}

#[test]
fn names_are_unique_and_usable_in_keys() {
    let message = broken(|scene| scene.bodies[0].name = "sponge".to_owned());
    assert_eq!(message, "`bodies[0].name` = \"sponge\": already the name of `sponges[0].name`");
    for name in ["", "7up", "a.b", "a b", "schw\u{e4}mmchen"] {
        let message = broken(|scene| scene.sponges[0].name = name.to_owned());
        assert!(message.starts_with(&format!("`sponges[0].name` = {name:?}")), "{message}");
    }
}

#[test]
fn bodies_of_the_wrong_kind_are_refused() {
    let message = broken(|scene| scene.bodies[0].shape = ShapeKind::Plane);
    assert!(message.contains("a plane has no mass"), "{message}");
    let message = broken(|scene| scene.bodies[0].grip = true);
    assert!(message.starts_with("`bodies[0].grip` = true"), "{message}");
    let motion = Motion::Linear { velocity: Vec3::X, start: 0.0, end: 1.0, ease: 0.0 };
    let message = broken(|scene| scene.bodies[0].motions.push(motion));
    assert!(message.contains("only a body of `kind` kinematic follows motions"), "{message}");
    let message = broken(|scene| {
        scene.bodies[0].kind = BodyKind::Fixed;
        scene.bodies[0].linear_velocity = Vec3::X;
    });
    assert!(message.starts_with("`bodies[0].linear_velocity` = [1, 0, 0]"), "{message}");
    let message = broken(|scene| {
        scene.bodies[0].kind = BodyKind::Kinematic;
        scene.bodies[0].motions.push(Motion::Linear { velocity: Vec3::X, start: 1.0, end: 1.0, ease: 0.0 });
    });
    assert!(message.contains("must be before `end` = 1"), "{message}");
    let eased = |ease| {
        move |scene: &mut Scene| {
            scene.bodies[0].kind = BodyKind::Kinematic;
            scene.bodies[0].motions.push(Motion::Linear { velocity: Vec3::X, start: 1.0, end: 3.0, ease });
        }
    };
    let message = broken(eased(1.5));
    assert!(message.starts_with("`bodies[0].motions[0].ease` = 1.5"), "{message}");
    assert!(message.contains("at most half of the time from `start` to `end`: 1"), "{message}");
    assert!(broken(eased(-0.1)).contains("ease"));
    let mut scene = full();
    eased(1.0)(&mut scene);
    assert_eq!(scene.problems(), []);
}

#[test]
fn degenerate_geometry_is_refused() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)].map(|p| 0.02 * p);
    let hull = |vertices: &[Vec3]| ShapeKind::Hull { vertices: vertices.to_vec() };
    assert!(broken(|scene| scene.bodies[0].shape = hull(&corners)).contains("lie in one plane"));
    assert!(broken(|scene| scene.bodies[0].shape = hull(&corners[..3])).contains("at least 4 points"));
    let mut scene = full();
    scene.bodies[0].shape = hull(&[corners[0], corners[1], corners[2], Vec3::new(0.0, 0.0, 0.02)]);
    assert_eq!(scene.problems(), []);
    assert!(broken(|scene| scene.bodies[0].rotation.axis = Vec3::ZERO).contains("must not be zero"));
    assert!(
        broken(|s| s.camera = Some(Camera { eye: Vec3::X, target: Vec3::X, ..Camera::default() }))
            .contains("must not be `camera.target`")
    );
}

#[test]
fn surprising_combinations_are_refused() {
    let message = broken(|scene| {
        scene.fluid = None;
        scene.sponges[0].saturation = 0.5;
    });
    assert!(message.contains("a scene without `fluid`"), "{message}");
    let message = broken(|scene| fluid(scene).spacing = 0.02);
    assert_eq!(message, "`sponges[0].edge` = 0.01: must be 1 to 8 times `fluid.spacing` = 0.02");
    let message = broken(|scene| scene.time.minimum_step = 0.01);
    assert!(message.starts_with("`time.minimum_step` = 0.01: must not be above"), "{message}");
    assert_eq!(full().with_body(Body::default()).problems(), []);
}

#[test]
fn a_scene_of_another_version_is_refused() {
    let message = broken(|scene| scene.version = 7);
    assert!(message.contains("`version` = 7 is an unknown version"), "{message}");
}

#[test]
fn too_many_particles_or_nodes_are_refused_before_anything_is_allocated() {
    let message = broken(|scene| {
        scene.sponges.clear();
        fluid(scene).spacing = 2e-4;
    });
    assert!(message.contains("particles; at most 50000000"), "{message}");
    let mut scene = Scene::default().with_sponge(Sponge { cells: UVec3::splat(200), ..Sponge::default() });
    assert!(only(&scene).to_string().contains("nodes; at most 10000000"));
    scene.sponges[0].cells = UVec3::splat(100);
    assert_eq!(scene.problems(), []);
}

#[test]
fn counts_of_a_block_are_exact() {
    let scene = Scene::default().with_sponge(Sponge::default());
    // 9^3 + 8^3 - 8 nodes; 4 tets around each of 3 * 7 * 64 inner faces.
    assert_eq!(scene.estimate(), Estimate { particles: 0, nodes: 1233, tets: 5376 });
    let block = FluidBlock::new(Vec3::splat(-0.1), Vec3::new(0.1, 0.02, 0.004));
    assert_eq!(block.counts(0.005), [40, 24, 20]);
    assert_eq!(FluidBlock::new(Vec3::ONE, Vec3::ZERO).counts(0.005), [0, 0, 0]);
}

#[test]
fn twice_the_resolution_has_eight_times_the_particles() {
    let scene = full();
    let fine = scene.scaled(2.0).expect("fits");
    let (coarse_count, fine_count) = (scene.estimate(), fine.estimate());
    let ratio = fine_count.particles as f64 / coarse_count.particles as f64;
    assert!((ratio - 8.0).abs() < 0.2, "{ratio}");
    assert_eq!(fine.sponges[0].cells, UVec3::splat(16));
    assert!((fine.sponges[0].size() - scene.sponges[0].size()).length() < 1e-6);
    let ratio = fine_count.nodes as f64 / coarse_count.nodes as f64;
    assert!((6.5..8.0).contains(&ratio), "{ratio}");
    assert_eq!(scene.scaled(1.0).expect("unchanged"), scene);
    // Cells stay cubes, so an odd number of them keeps the length along x only.
    let bar = Scene::default().with_sponge(Sponge { cells: UVec3::new(4, 9, 3), ..Sponge::default() });
    let coarse = bar.scaled(0.5).expect("open domain");
    assert_eq!(coarse.sponges[0].cells, UVec3::new(2, 5, 2));
    assert_eq!(coarse.sponges[0].edge, 0.02);
    let (before, after) = (&bar.sponges[0], &coarse.sponges[0]);
    assert_eq!(after.position.y, before.position.y);
    assert_eq!(after.position.z + after.size().z / 2.0, before.position.z + before.size().z / 2.0);
    assert_ne!(after.size().z, before.size().z, "nothing was rounded: the middle could not have moved");
}

#[test]
fn resolutions_out_of_range_are_refused() {
    for resolution in [0.0, 0.09, 8.1, f32::NAN, -1.0] {
        let error = full().scaled(resolution).expect_err("out of range").to_string();
        assert!(error.ends_with("is out of range 0.1 to 8"), "{error}");
    }
}

#[test]
fn the_automatic_camera_sees_the_whole_scene() {
    let scene = full();
    assert_eq!(scene.camera, None);
    let camera = scene.viewpoint();
    assert_eq!(only_camera_problem(&scene, camera), None);
    let forward = (camera.target - camera.eye).normalize();
    let (minimum, maximum) = scene.bounds();
    let half_angle = 0.5 * camera.field_of_view_degrees.to_radians();
    for corner in 0..8u32 {
        let pick = |axis: usize| {
            if corner >> axis & 1 == 0 { minimum[axis] } else { maximum[axis] }
        };
        let ray = (Vec3::new(pick(0), pick(1), pick(2)) - camera.eye).normalize();
        assert!(ray.dot(forward) > libm::cosf(half_angle), "corner {corner}");
    }
    let chosen = Camera { eye: Vec3::ONE, ..Camera::default() };
    assert_eq!(scene.with_camera(chosen).viewpoint(), chosen);
}

fn only_camera_problem(scene: &Scene, camera: Camera) -> Option<Problem> {
    scene.clone().with_camera(camera).problems().pop()
}

#[test]
fn the_default_speed_of_sound_follows_the_fastest_water() {
    let mut scene = full();
    // 3 cm of water fall at 0.77 m/s, 500 Pa of suction pull at 1 m/s.
    assert!((scene.default_sound_speed() - 10.0).abs() < 1e-4);
    scene.sponges.clear();
    assert!((scene.default_sound_speed() - 7.672).abs() < 1e-2);
    scene.fluid = None;
    assert_eq!(scene.default_sound_speed(), 0.0);
}

/// Water that fills a box of 6 x 4 x 5 cm, which repeats along some axes.
fn repeating(axes: [bool; 3]) -> Scene {
    let high = Vec3::new(0.06, 0.04, 0.05);
    let fluid = Fluid { blocks: vec![FluidBlock::new(Vec3::ZERO, high)], ..Fluid::default() };
    Scene::new("repeating").in_box(Vec3::ZERO, high).with_fluid(fluid).repeating(axes)
}

#[test]
fn what_repeats_is_longer_than_pairs_reach() {
    let mut scene = repeating([true, false, true]);
    assert_eq!(scene.problems(), []);
    fluid(&mut scene).surface_tension = 0.07;
    assert_eq!(scene.problems(), [], "5 cm are more than four times 1 cm");
    fluid(&mut scene).support = 2.75;
    let text = "`domain.periodic[2]` = true: needs a box longer than 0.055 m along this axis, \
    twice the radius of the neighbour search; it is 0.05 m";
    assert_eq!(only(&scene).to_string(), text);
    // Where there are walls, and with the equation of state, the radius is another one.
    assert_eq!(scene.clone().repeating([true, true, false]).problems().len(), 1);
    assert_eq!(scene.clone().repeating([true, false, false]).problems(), []);
    fluid(&mut scene).solver = Some(FluidSolver::Wcsph);
    assert_eq!(scene.problems(), []);
}

#[test]
fn what_repeats_holds_whole_spacings_of_water() {
    let mut scene = repeating([true, false, true]);
    assert_eq!(scene.estimate().particles, 12 * 8 * 10);
    fluid(&mut scene).spacing = 0.0053;
    let problems: Vec<String> = scene.problems().iter().map(ToString::to_string).collect();
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(problems[0].starts_with("`fluid.blocks[0]` = (0.06 m along x)"), "{}", problems[0]);
    assert!(
        problems[0].contains("whole number of `fluid.spacing` = 0.0053 long; 11 of 0.00545"),
        "{problems:?}"
    );
    // A block that leaves room may have any length.
    let block = &mut fluid(&mut scene).blocks[0];
    (block.maximum.x, block.maximum.z) = (0.05, 0.04);
    assert_eq!(scene.problems(), []);
    assert_eq!(scene.estimate().particles, 9 * 7 * 7);
}

#[test]
fn sponges_do_not_repeat() {
    let message = only(&full().repeating([false, false, true])).to_string();
    assert!(message.contains("no periodic images"), "{message}");
    assert_eq!(full().repeating([false; 3]).problems(), []);
    let open = Scene::default().repeating([true; 3]);
    assert_eq!(open.periodic(), [false; 3], "an open scene has no length that could repeat");
}

#[test]
fn barycentric_weights_need_the_divergence_step() {
    let mut scene = full();
    scene.sponges.iter_mut().for_each(|sponge| sponge.solver = Solver::Vbd);
    assert_eq!(scene.coupling_weights(), CouplingWeights::Barycentric);
    let soft = scene.sponges[0].largest_suction() * 0.99;
    let stiff = std::mem::replace(&mut scene.sponges[0].young_modulus, soft);
    assert_eq!(scene.coupling_weights(), CouplingWeights::Smoothed, "suction crushes it");
    scene.sponges[0].young_modulus = stiff;
    fluid(&mut scene).coupling_weights = Some(CouplingWeights::Barycentric);
    assert_eq!(scene.problems(), []);
    fluid(&mut scene).solver = Some(FluidSolver::Dfsph);
    let message = only(&scene).to_string();
    assert!(message.contains("`fluid.coupling_weights`") && message.contains("\"barycentric\""), "{message}");
}

#[test]
fn the_divergence_step_has_sponges_as_porous_media_only() {
    let mut scene = full();
    scene.sponges.iter_mut().for_each(|sponge| sponge.solver = Solver::Vbd);
    (fluid(&mut scene).solver, fluid(&mut scene).coupling) = (Some(FluidSolver::Divergence), None);
    assert_eq!(scene.problems(), []);
    let mut of_the_paper = scene.clone();
    fluid(&mut of_the_paper).coupling = Some(Coupling::Paper);
    let mut by_strain = scene;
    by_strain.sponges[0].solver = Solver::Sbd;
    for scene in [of_the_paper, by_strain] {
        let message = only(&scene).to_string();
        assert!(message.contains("`fluid.solver`") && message.contains("\"paper\""), "{message}");
    }
}

#[test]
fn retention_needs_the_divergence_step() {
    let mut scene = full();
    fluid(&mut scene).solver = Some(FluidSolver::Dfsph);
    assert_eq!(scene.problems(), []);
    fluid(&mut scene).retention = 0.05;
    let message = only(&scene).to_string();
    assert!(message.contains("`fluid.retention`") && message.contains("\"divergence\""), "{message}");
}
