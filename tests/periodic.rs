//! Periodic containers: particles that leave on one side enter on the other, and the place of the sides does not matter.

mod common;

use sorb::{
    Options, SimdLevel, World,
    glam::{DVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, FluidSolver, Motion, Scene, ShapeKind, ViscosityForm},
};

const SPACING: f32 = 0.005;
/// Length of the box along its axes.
const SIZE: Vec3 = Vec3::new(12.0 * SPACING, 10.0 * SPACING, 8.0 * SPACING);

/// A full box with its corner anywhere.
fn full(periodic: [bool; 3]) -> Scene {
    let corner = Vec3::new(-0.02, 0.01, 0.005);
    let fluid =
        Fluid { spacing: SPACING, blocks: vec![FluidBlock::new(corner, corner + SIZE)], ..Fluid::default() };
    let scene = Scene { gravity: Vec3::ZERO, ..Scene::new("full") };
    scene.in_box(corner, corner + SIZE).with_fluid(fluid).repeating(periodic)
}

/// Shallow water that flows across two sides, under a plate that moves with it and is longer than the box.
fn channel() -> Scene {
    let mut scene = full([true, false, true]);
    scene.gravity = Vec3::new(3.0, -9.81, 1.0);
    scene.name = "channel".to_owned();
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks[0].maximum.y -= 0.4 * SIZE.y;
        fluid.blocks[0].velocity = Vec3::new(0.8, 0.3, -0.5);
        fluid.no_slip = true;
    }
    let motion = Motion::Linear { velocity: Vec3::new(0.5, -0.1, 0.0), start: 0.0, end: 0.02, ease: 0.0 };
    let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.2, 0.004, 0.2) };
    let body = Body::kinematic("plate", shape, Vec3::new(0.0, 0.049, 0.0), vec![motion]);
    scene.with_body(Body { no_slip: true, ..body })
}

fn fluid(scene: &mut Scene) -> &mut Fluid {
    scene.fluid.as_mut().unwrap_or_else(|| panic!("no water"))
}

/// A divergence-free field that fits the box.
fn whirl(scene: &Scene, speed: f32) -> impl Fn(Vec3) -> Vec3 {
    let (corner, _) = scene.bounds();
    move |at: Vec3| {
        let [x, y, z] = ((at - corner) / SIZE * std::f32::consts::TAU).to_array();
        Vec3::new(libm::sinf(y) + libm::cosf(z), libm::sinf(z), libm::sinf(x) + libm::cosf(y)) * speed
    }
}

/// Positions or velocities in the order of the particles' identities.
fn by_id(world: &World, rows: &[[f32; 4]]) -> Vec<DVec3> {
    let mut all: Vec<(u32, DVec3)> = world
        .particle_ids()
        .iter()
        .zip(rows)
        .map(|(id, [x, y, z, _])| (*id, Vec3::new(*x, *y, *z).as_dvec3()))
        .collect();
    all.sort_by_key(|(id, _)| *id);
    all.into_iter().map(|(_, row)| row).collect()
}

/// The difference from b to a, across the sides where that is shorter.
fn apart(a: DVec3, b: DVec3, periodic: [bool; 3]) -> DVec3 {
    let period = SIZE.as_dvec3();
    DVec3::select(periodic.into(), (a - b) - period * ((a - b) / period).round(), a - b)
}

/// Every particle of a block that fills the box has neighbours a spacing away on both sides of every axis.
fn has_seams(scene: &Scene, periodic: [bool; 3]) -> bool {
    let world = common::world(scene);
    let places = by_id(&world, world.particle_positions());
    let spacing = f64::from(SPACING);
    let beside = |a: &DVec3| {
        // Initial positions are displaced by up to a hundredth of a spacing.
        let near = |b: &&DVec3| (apart(*a, **b, periodic).length() / spacing - 1.0).abs() < 0.05;
        places.iter().filter(near).count()
    };
    places.iter().any(|place| beside(place) != 6)
}

#[test]
fn rows_are_a_spacing_apart_across_the_sides() {
    assert!(!has_seams(&full([true; 3]), [true; 3]));
    // A length that is no whole number of spacings, within a thousandth.
    let mut stretched = full([true; 3]);
    fluid(&mut stretched).spacing *= 0.9995;
    assert!(!has_seams(&stretched, [true; 3]));
    assert_eq!(common::world(&stretched).particle_ids().len(), 12 * 10 * 8);
    // Negative control: where one axis does not repeat.
    assert!(has_seams(&full([true; 3]), [true, true, false]));
}

#[test]
fn a_full_box_that_repeats_is_at_rest_density_everywhere() {
    let errors = |periodic| {
        let mut scene = full(periodic);
        // With the pressure solve there is no density.
        fluid(&mut scene).solver = Some(FluidSolver::Wcsph);
        let world = common::world(&scene);
        let density = &sorb::internal::columns(&world).fluid.density[..world.particle_ids().len()];
        density.iter().map(|density| f64::from((density / 1000.0 - 1.0).abs())).fold(0.0, f64::max)
    };
    // Initial positions are displaced by up to a hundredth of a spacing: 1.1 %.
    assert!(errors([true; 3]) < 0.02, "{}", errors([true; 3]));
    // Negative control: at walls neighbours are missing.
    assert!(errors([true, false, true]) > 0.1);
}

#[test]
fn momentum_is_kept_without_gravity() {
    for solver in [FluidSolver::Dfsph, FluidSolver::Wcsph] {
        let error = |periodic| {
            let mut scene = full(periodic);
            let fluid = fluid(&mut scene);
            (fluid.solver, fluid.viscosity, fluid.sound_speed) = (Some(solver), 0.5, Some(10.0));
            let (mut world, whirl) = (common::world(&scene), whirl(&scene, 0.3));
            let field = |at| whirl(at) + Vec3::new(0.2, 0.1, -0.1);
            world.set_particle_velocities(field).unwrap_or_else(|error| panic!("{error}"));
            let speed = |world: &World| {
                let all = world.particle_velocities().iter();
                all.map(|[x, y, z, _]| f64::from(Vec3::new(*x, *y, *z).length())).sum::<f64>()
            };
            let scale = speed(&world) / world.particle_ids().len() as f64 * world.measures().water_mass;
            let before = world.measures().linear_momentum;
            while world.clock().time < 0.04 {
                common::steps(&mut world, 1);
            }
            assert_eq!(common::unhealthy(&world, world.particle_ids().len()), None);
            (world.measures().linear_momentum - before).length() / scale
        };
        assert!(error([true; 3]) < 1e-5, "{solver:?}: {:.1e}", error([true; 3]));
        // Negative control: walls take momentum.
        assert!(error([true, false, true]) > 1e-3, "{solver:?}");
    }
}

/// Largest displacement of particles from those of the scene without offset, over the spacing, after some steps.
fn wandered(scene: &Scene, steps: u32, offset: Vec3, fault: f32) -> f64 {
    let periodic = scene.periodic();
    let mut places = Vec::new();
    for (moved, speed) in [(Vec3::ZERO, 0.3), (offset, 0.3 + fault)] {
        let mut scene = scene.clone();
        let (low, high) = scene.bounds();
        scene = scene.in_box(low + moved, high + moved).repeating(periodic);
        let block = &mut fluid(&mut scene).blocks[0];
        (block.minimum, block.maximum) = (block.minimum + moved, block.maximum + moved);
        let mut world = common::world(&scene);
        world.set_particle_velocities(whirl(&scene, speed)).unwrap_or_else(|error| panic!("{error}"));
        common::steps(&mut world, steps);
        let back = |place: DVec3| place - moved.as_dvec3();
        places.push(by_id(&world, world.particle_positions()).into_iter().map(back).collect::<Vec<_>>());
    }
    let pairs = places[0].iter().zip(&places[1]);
    pairs.map(|(a, b)| apart(*a, *b, periodic).length()).fold(0.0, f64::max) / f64::from(SPACING)
}

#[test]
fn where_the_box_begins_does_not_matter() {
    let offset = Vec3::new(0.0137, -0.0071, 0.0203);
    for solver in [FluidSolver::Dfsph, FluidSolver::Wcsph] {
        let mut scene = full([true; 3]);
        let fluid = fluid(&mut scene);
        (fluid.solver, fluid.sound_speed) = (Some(solver), Some(10.0));
        // The same number of iterations in any case: within a tolerance, rounding may cost one more.
        (fluid.density_tolerance, fluid.rounds) = (1e-6, 4);
        // Measured: 2.9e-6 and 3.8e-6.
        let moved = wandered(&scene, 4, offset, 0.0);
        assert!(moved < 2e-5, "{solver:?}: {moved:.1e}");
        // Negative control: a thousandth faster, 7.0e-5 and 1.3e-4.
        let faster = wandered(&scene, 4, offset, 3e-4);
        assert!(faster > 4e-5, "{solver:?}: {faster:.1e}");
    }
}

#[test]
fn a_channel_is_the_same_on_all_threads_and_levels() {
    let scene = channel();
    let run = |scene: &Scene, threads, simd, steps| {
        let options = Options { threads: Some(threads), simd: Some(simd), ..Options::default() };
        let mut world = World::with_options(scene, &options).unwrap_or_else(|error| panic!("{error}"));
        common::steps(&mut world, steps);
        world
    };
    let first = run(&scene, 1, SimdLevel::Fallback, 40);
    // The scene is worth the comparison: the plate is pushed, and water has crossed the sides.
    assert!(common::bodies_are_pushed(&first));
    let start = by_id(&common::world(&scene), common::world(&scene).particle_positions());
    let end = by_id(&first, first.particle_positions());
    assert!(start.iter().zip(&end).any(|(a, b)| (a.x - b.x).abs() > 0.5 * f64::from(SIZE.x)));
    for simd in SimdLevel::supported() {
        for threads in [1, 2, 3] {
            let digest = run(&scene, threads, simd, 40).digest();
            assert_eq!(digest, first.digest(), "{threads} threads, {simd}");
        }
    }
    let mut other = scene.clone();
    other.gravity.x = other.gravity.x.next_up();
    assert_ne!(run(&other, 1, SimdLevel::Fallback, 40).digest(), first.digest(), "gravity by one bit");
    assert_eq!(common::unhealthy(&first, first.particle_ids().len()), None);
    let text = format!("{}\ndigest {:016x}", common::line(&first), first.state_digest());
    common::golden("digest_channel", &text);
}

/// Water in a periodic channel on a slope: it keeps its mass, stays in the box, and is as fast as gravity makes it.
#[test]
fn water_runs_through_a_channel_for_ever() {
    let mut scene = channel();
    scene.bodies.clear();
    fluid(&mut scene).no_slip = false;
    fluid(&mut scene).blocks[0].velocity = Vec3::ZERO;
    scene.gravity = Vec3::new(3.0, -9.81, 0.0);
    let mut world = common::world(&scene);
    let mass = world.measures().water_mass;
    while world.clock().time < 0.3 {
        common::steps(&mut world, 1);
    }
    let m = world.measures();
    assert_eq!(m.water_mass.to_bits(), mass.to_bits());
    let speed = m.linear_momentum.x / mass;
    // Nothing holds it: walls have free slip, and none is in its way.
    assert!((speed / (3.0 * world.clock().time) - 1.0).abs() < 1e-3, "{speed}");
    assert_eq!(common::unhealthy(&world, world.particle_ids().len()), None);
    // Negative control: walls stop it.
    let mut held = common::world(&scene.clone().repeating([false; 3]));
    while held.clock().time < 0.3 {
        common::steps(&mut held, 1);
    }
    assert!(held.measures().linear_momentum.x / mass < 0.5 * speed);
}

/// The step of explicit viscosity is stable: a slow flow between sticky walls has the speed of Poiseuille, and nothing else moves.
#[test]
fn viscous_flow_is_as_slow_as_its_viscosity_says() {
    // Along the axes of a lattice Monaghan's form has 0.6 of its viscosity (docs/viscosity.md).
    for (form, most) in
        [(ViscosityForm::Morris, 1.1), (ViscosityForm::StrainRate, 1.1), (ViscosityForm::Monaghan, 1.7)]
    {
        let mut scene = full([true, false, true]);
        scene.gravity = Vec3::X;
        let water = fluid(&mut scene);
        (water.viscosity, water.viscosity_form, water.no_slip) = (30.0, Some(form), true);
        let kinematic = water.viscosity / water.rest_density;
        let mut world = common::world(&scene);
        // Twice the time in which viscosity crosses the channel.
        while world.clock().time < f64::from(2.0 * SIZE.y * SIZE.y / kinematic) {
            common::frame(&mut world);
        }
        let expected = SIZE.y * SIZE.y / (8.0 * kinematic);
        let rows = world.particle_velocities();
        let fastest = rows.iter().map(|row| row[0]).fold(0.0, f32::max);
        let across = rows.iter().map(|row| row[1].abs().max(row[2].abs())).fold(0.0, f32::max);
        let part = fastest / expected;
        assert!(part > 0.9 && part < most, "{form:?}: {fastest} m/s instead of {expected} m/s");
        assert!(across < 0.1 * expected, "{form:?}: {across} m/s across the flow of {expected} m/s");
    }
}
