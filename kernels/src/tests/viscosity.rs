//! The solve for the implicit viscosity: what it keeps, what it takes, and what it is the limit of.

use glam::DVec3;

use super::scene::{FULL, Options, Scene, best};

/// Free fluid: nothing takes momentum from it.
const FREE: Options =
    Options { sponges: false, bodies: false, walls: false, implicit_viscosity: true, ..FULL };
/// Free fluid with viscosity by the rate of strain.
const STRAINED: Options = Options { strain_rate: true, ..FREE };
/// Fluid among bodies that it does not slide along.
const AMONG: Options = Options { bodies: true, ..FREE };

/// An iteration, which begins later without viscosity by the rate of strain.
const ROUND: [&str; 4] =
    ["sph::viscosity_spin", "sph::viscosity_strain", "sph::viscosity_product", "sph::viscosity_update"];

fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

/// The scene after the kick, at a step.
fn kicked(options: Options, step: f32) -> Scene {
    let mut scene = Scene::new(options).before("sph::viscosity_begin", &best());
    scene.params.step = step;
    scene
}

fn set(scene: &mut Scene, tolerance: f32, rounds: u32) {
    let implicit = scene.params.fluid.implicit_viscosity.as_mut().expect("the options ask for it");
    (implicit.tolerance, implicit.rounds) = (tolerance, rounds);
}

/// Solves, and gives the velocities before and after.
fn solve(scene: &mut Scene) -> [Vec<DVec3>; 2] {
    let velocities = |scene: &Scene| -> Vec<DVec3> {
        scene.columns.fluid.velocity[..scene.columns.rows.fluid].iter().map(|row| vector(*row)).collect()
    };
    let before = velocities(scene);
    let is_strained = scene.params.fluid.strain_viscosity > 0.0;
    scene.run(&best(), &["sph::viscosity_begin"]);
    loop {
        scene.run(&best(), if is_strained { &ROUND } else { &ROUND[2..] });
        if scene.columns.fluid.viscosity_solve.is_converged() {
            break;
        }
    }
    scene.run(&best(), &["sph::viscosity_reaction", "sph::viscosity_kick"]);
    [before, velocities(scene)]
}

/// Momentum that the fluid gains, over the sum of the magnitudes of what its particles gain.
fn gained(scene: &Scene, [before, after]: &[Vec<DVec3>; 2], given: DVec3) -> f64 {
    let mass = f64::from(scene.params.fluid.particle_mass);
    let changes = || before.iter().zip(after).map(|(before, after)| mass * (*after - *before));
    let magnitude: f64 = changes().map(DVec3::length).sum();
    assert!(magnitude > 0.0, "nothing happens");
    (changes().sum::<DVec3>() + given).length() / magnitude
}

/// What all bodies were given by the friction of the fluid.
fn given(scene: &Scene, before: &Scene) -> DVec3 {
    let sum = |scene: &Scene| -> DVec3 {
        scene.columns.bodies.fluid_wrenches.0.iter().map(|wrench| wrench.impulse).sum()
    };
    sum(scene) - sum(before)
}

#[test]
fn pairs_keep_momentum_after_any_number_of_rounds() {
    let ends = [(0.0, 1), (0.0, 2), (0.0, 7), (1e-3, 200)];
    for (options, (tolerance, rounds)) in [FREE, STRAINED].iter().flat_map(|o| ends.map(|end| (*o, end))) {
        let mut scene = kicked(options, 0.02);
        set(&mut scene, tolerance, rounds);
        let mut motion = solve(&mut scene);
        let error = gained(&scene, &motion, DVec3::ZERO);
        assert!(error < 2e-6, "{rounds} rounds: {error:.1e}");
        // Negative control: one particle of a thousand that is ten per cent faster.
        motion[1][500] *= 1.1;
        assert!(gained(&scene, &motion, DVec3::ZERO) > 5e-6);
    }
}

/// Angular momentum that the fluid gains, over the sum of the magnitudes of what its particles gain.
fn turned(scene: &Scene, [before, after]: &[Vec<DVec3>; 2]) -> f64 {
    let points = scene.columns.fluid.position.iter().map(|row| vector(*row));
    let gains = before.iter().zip(after).zip(points).map(|((before, after), x)| x.cross(*after - *before));
    let (sum, magnitude) =
        gains.fold((DVec3::ZERO, 0.0), |(sum, all), gain| (sum + gain, all + gain.length()));
    assert!(magnitude > 0.0, "nothing happens");
    sum.length() / magnitude
}

#[test]
fn viscosity_by_the_rate_of_strain_turns_nothing() {
    let of = |options| {
        let mut scene = kicked(options, 0.02);
        if options.strain_rate {
            let implicit = scene.params.fluid.implicit_viscosity.as_mut().expect("the options ask for it");
            (implicit.viscosity, implicit.central_viscosity) = (0.0, 0.0);
        }
        set(&mut scene, 1e-3, 200);
        let motion = solve(&mut scene);
        turned(&scene, &motion)
    };
    assert!(of(STRAINED) < 5e-6, "{:.1e}", of(STRAINED));
    // The control: the form that acts on all of the relative velocity.
    assert!(of(FREE) > 1e-4, "{:.1e}", of(FREE));
}

#[test]
fn bodies_take_what_the_fluid_loses() {
    for tolerance in [1e-1, 1e-3] {
        let mut scene = kicked(AMONG, 0.02);
        set(&mut scene, tolerance, 500);
        let before = scene.clone();
        let motion = solve(&mut scene);
        assert!(scene.columns.fluid.viscosity_solve.is_solved());
        let given = given(&scene, &before);
        let error = gained(&scene, &motion, given);
        assert!(error < 2e-6, "tolerance {tolerance}: {error:.1e}");
        // Negative control: bodies that take a thousandth less, which a tolerance would have excused.
        assert!(gained(&scene, &motion, 0.999 * given) > 1e-5);
    }
}

#[test]
fn uniform_motion_is_left_alone() {
    let drift = [3.0_f32, -2.0, 1.0];
    let run = |extra: f32| {
        let mut scene = kicked(FREE, 0.02);
        for row in &mut scene.columns.fluid.velocity[..FULL.fluid] {
            row[..3].copy_from_slice(&drift);
        }
        scene.columns.fluid.velocity[100][0] += extra;
        let [before, after] = solve(&mut scene);
        let is_same = before.iter().zip(&after).all(|(before, after)| before == after);
        (is_same, scene.columns.fluid.viscosity_solve.rounds())
    };
    assert_eq!(run(0.0), (true, 1), "to the bit, in one round");
    assert!(!run(1e-3).0, "the control");
}

#[test]
fn energy_falls_and_shear_dies() {
    let kinetic = |velocities: &[DVec3]| velocities.iter().map(|v| v.length_squared()).sum::<f64>();
    // Whatever it is that ends the rounds.
    for (tolerance, rounds) in [(0.0, 1), (0.0, 3), (0.0, 20), (1e-4, 1000)] {
        let mut scene = kicked(FREE, 0.1);
        set(&mut scene, tolerance, rounds);
        let [before, after] = solve(&mut scene);
        assert!(kinetic(&after) < kinetic(&before), "{rounds}");
    }
    // Fluid that is very thick moves as one, but for its rotation.
    let mut scene = kicked(FREE, 0.1);
    set(&mut scene, 1e-5, 1000);
    let [before, after] = solve(&mut scene);
    let mean = after.iter().sum::<DVec3>() / after.len() as f64;
    let spread = |all: &[DVec3]| all.iter().map(|v| v.distance_squared(mean)).sum::<f64>();
    assert!(spread(&after) < 1e-2 * spread(&before), "{:.1e}", spread(&after) / spread(&before));
}

/// Largest difference of two fields, over the largest of the second.
fn difference(a: &[DVec3], b: &[DVec3]) -> f64 {
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    largest(&mut a.iter().zip(b).map(|(a, b)| a.distance(*b))) / largest(&mut b.iter().map(|b| b.length()))
}

#[test]
fn short_steps_are_those_of_explicit_viscosity() {
    // How far the accelerations of both are apart at a step; `factor` falsifies the explicit viscosity.
    let apart = |step: f32, factor: f32| {
        // With the volumes that the solve takes: those at rest density.
        let mut scene = Scene::new(Options { incompressible: true, ..AMONG }).before("sph::forces", &best());
        scene.params.step = step;
        let implicit = scene.params.fluid.implicit_viscosity.expect("the options ask for it");
        let mut explicit = scene.clone();
        explicit.params.fluid.implicit_viscosity = None;
        explicit.params.fluid.viscosity = factor * implicit.viscosity;
        explicit.params.fluid.central_viscosity = factor * implicit.central_viscosity;
        scene.params.fluid.viscosity = 0.0;
        scene.params.fluid.central_viscosity = 0.0;
        let accelerations = |scene: &Scene| -> Vec<DVec3> {
            scene.columns.fluid.acceleration[..FULL.fluid].iter().map(|row| vector(*row)).collect()
        };
        scene.run(&best(), &["sph::forces"]);
        let others = accelerations(&scene);
        // The velocities of both are those before the kick: what counts is what viscosity makes of them.
        scene.columns.fluid.acceleration.iter_mut().for_each(|row| *row = [0.0; 4]);
        set(&mut scene, 1e-6, 500);
        let [before, after] = solve(&mut scene);
        let found = before.iter().zip(after).map(|(before, after)| (after - *before) / f64::from(step));
        let found: Vec<DVec3> = found.collect();
        explicit.run(&best(), &["sph::forces", "sph::wall_friction"]);
        let expected: Vec<DVec3> =
            accelerations(&explicit).iter().zip(&others).map(|(all, others)| *all - *others).collect();
        difference(&found, &expected)
    };
    let [long, middle, short] = [1e-4, 1e-5, 1e-6].map(|step| apart(step, 1.0));
    assert!(short < 0.01 && middle < 0.1 && long > 0.1, "{long:.1e} {middle:.1e} {short:.1e}");
    assert!(middle / short > 5.0, "of first order: {middle:.1e} {short:.1e}");
    assert!(apart(1e-6, 1.05) > 0.04, "the control: one twentieth more explicit viscosity");
}
