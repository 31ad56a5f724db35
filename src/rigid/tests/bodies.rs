//! Free bodies: the discrete formulas, mass and inertia, momenta and energies.

use super::*;
use crate::rigid::{MassProperties, Mechanics, RapierEngine, convex_hull};
use glam::{DMat3, Mat3};

fn engine(gravity: Vec3, bodies: &[BodySetup]) -> RapierEngine {
    RapierEngine::new(gravity, None, bodies).expect("the bodies are valid")
}

/// A skew tetrahedron of a few centimetres: no two principal moments are equal.
fn splinter(position: Vec3) -> BodySetup {
    let points =
        [Vec3::ZERO, Vec3::new(0.05, 0.0, 0.01), Vec3::new(0.0, 0.03, 0.02), Vec3::new(0.01, 0.01, 0.04)];
    let hull = convex_hull(&points).expect("the points span a solid");
    body("splinter", BodyKind::Dynamic, hull.shape, position)
}

fn shapes() -> [BodySetup; 4] {
    let half_extents = Vec3::new(0.01, 0.03, 0.02);
    let capsule = Shape::Capsule { half_height: 0.03, radius: 0.01 };
    [
        ball(Vec3::ZERO),
        body("box", BodyKind::Dynamic, Shape::Cuboid { half_extents }, Vec3::X),
        body("capsule", BodyKind::Dynamic, capsule, Vec3::X * 2.0),
        splinter(Vec3::X * 3.0),
    ]
}

#[test]
fn free_fall_follows_the_discrete_formula() {
    let mut engine = engine(GRAVITY, &[ball(Vec3::Y)]);
    let steps = [1.0 / 60.0, 1.0 / 100.0, 1.0 / 240.0].repeat(10);
    let (mut height, mut speed) = (1.0_f64, 0.0_f64);
    for dt in steps {
        step(&mut engine, dt, 1);
        let h = f64::from(dt) / 4.0;
        for _ in 0..4 {
            speed += f64::from(GRAVITY.y) * h;
            height += speed * h;
        }
    }
    let state = engine.state(0);
    assert!((f64::from(state.position.y) - height).abs() < 1e-6, "{} instead of {height}", state.position.y);
    assert!((f64::from(state.linear_velocity.y) - speed).abs() < 1e-5);
    // Negative control: one update per step instead of four is off by far more than the tolerance.
    assert!((1.0 - 0.5 * 9.81 * engine.time().powi(2) - height).abs() > 1e-3);
}

#[test]
fn an_impulse_changes_the_velocity_by_impulse_over_mass() {
    let mut engine = engine(Vec3::ZERO, &shapes());
    let masses: Vec<f64> = shapes()
        .iter()
        .map(|body| MassProperties::new(&body.shape, body.density).expect("a solid has a mass").mass)
        .collect();
    let wrenches = [
        impulse(0.01, 0.0, 0.0),
        impulse(0.0, -0.02, 0.0),
        impulse(0.0, 0.0, 0.03),
        impulse(0.01, 0.02, 0.03),
    ];
    engine.step(0.01, &wrenches).expect("the wrenches are finite");
    for (index, (wrench, mass)) in wrenches.iter().zip(&masses).enumerate() {
        let expected = (wrench.impulse / mass).as_vec3();
        assert_close(engine.state(index).linear_velocity, expected, 1e-6 * expected.length());
        assert_eq!(engine.state(index).angular_velocity, Vec3::ZERO);
        assert!((f64::from(engine.inverse_mass(index)) * mass - 1.0).abs() < 1e-6);
    }
}

#[test]
fn an_angular_impulse_changes_the_spin_by_inverse_inertia() {
    let axis = Vec3::new(1.0, -2.0, 0.5).normalize();
    let bodies = shapes().map(|body| {
        let state = BodyState { rotation: Quat::from_axis_angle(axis, 0.8), ..body.state };
        BodySetup { state, ..body }
    });
    let mut engine = engine(Vec3::ZERO, &bodies);
    let kick = DVec3::new(2e-6, -1e-6, 3e-6);
    let inverses: Vec<Mat3> = (0..bodies.len()).map(|index| engine.inverse_inertia(index)).collect();
    // The step is so short that the gyroscopic torque does not matter.
    engine
        .step(1e-6, &[Wrench { angular_impulse: kick, ..Wrench::default() }; 4])
        .expect("the wrenches are finite");
    for (index, body) in bodies.iter().enumerate() {
        let solid = MassProperties::new(&body.shape, body.density).expect("a solid has a mass");
        let inverse = solid.world_inertia(body.state.rotation).inverse();
        let expected = (inverse * kick).as_vec3();
        assert_close(engine.state(index).angular_velocity, expected, 1e-5 * expected.length());
        assert_eq!(engine.state(index).linear_velocity, Vec3::ZERO);
        let error = inverses[index].as_dmat3() * solid.world_inertia(body.state.rotation) - DMat3::IDENTITY;
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-5), "{}: {error}", body.name);
    }
}

#[test]
fn a_hard_kick_is_not_clipped() {
    let mut engine = engine(Vec3::ZERO, &[ball(Vec3::ZERO)]);
    let kick = Wrench { impulse: DVec3::X * 20.0, angular_impulse: DVec3::Y * 0.004 };
    let expected = engine.inverse_inertia(0) * Vec3::Y * 0.004;
    assert!(expected.length() > 900.0, "rapier3d would clip a spin like this by default");
    engine.step(1.0 / 120.0, &[kick]).expect("the wrench is finite");
    assert_close(engine.state(0).angular_velocity, expected, 1e-2);
    assert_close(engine.state(0).linear_velocity, Vec3::X * 20.0 * engine.inverse_mass(0), 1e-2);
}

#[test]
fn mass_properties_agree_with_sums_over_a_grid() {
    for body in shapes() {
        let exact = MassProperties::new(&body.shape, body.density).expect("a solid has a mass");
        let inside = |x: DVec3| match &body.shape {
            Shape::Plane => false,
            Shape::Sphere { radius } => x.length() <= f64::from(*radius),
            Shape::Cuboid { half_extents } => x.abs().cmple(half_extents.as_dvec3()).all(),
            Shape::Capsule { half_height, radius } => {
                let h = f64::from(*half_height);
                (x - DVec3::Y * x.y.clamp(-h, h)).length() <= f64::from(*radius)
            }
            Shape::Hull { planes, .. } => planes.iter().all(|(n, d)| n.as_dvec3().dot(x) <= f64::from(*d)),
            Shape::Compound(compound) => compound.parts.iter().any(|part| part.distance(x.as_vec3()) <= 0.0),
        };
        let (cells, half) = (80_i32, 0.0443);
        let edge = 2.0 * half / f64::from(cells);
        let cell_mass = f64::from(body.density) * edge.powi(3);
        let (mut mass, mut inertia) = (0.0, DMat3::ZERO);
        let at = |i: i32| (f64::from(i) + 0.5) * edge - half;
        for (i, j, k) in (0..cells.pow(3)).map(|n| (n % cells, n / cells % cells, n / cells / cells)) {
            let x = DVec3::new(at(i), at(j), at(k));
            if inside(x) {
                mass += cell_mass;
                let outer = DMat3::from_cols(x * x.x, x * x.y, x * x.z);
                inertia += (DMat3::from_diagonal(DVec3::splat(x.length_squared())) - outer) * cell_mass;
            }
        }
        assert!((mass / exact.mass - 1.0).abs() < 0.03, "{}: {mass} and {}", body.name, exact.mass);
        let scale = exact.inertia.x_axis.x.max(exact.inertia.y_axis.y);
        let error = (inertia - exact.inertia) * (1.0 / scale);
        assert!(error.to_cols_array().iter().all(|e| e.abs() < 0.05), "{}: {error}", body.name);
    }
}

#[test]
fn a_spinning_splinter_keeps_momenta_and_energy() {
    let state = BodyState {
        linear_velocity: Vec3::new(0.1, 0.2, 0.0),
        angular_velocity: Vec3::new(3.0, -5.0, 2.0),
        ..at_rest(Vec3::new(0.1, 0.0, 0.3))
    };
    let mut engine = engine(Vec3::ZERO, &[BodySetup { state, ..splinter(Vec3::ZERO) }]);
    let before = Mechanics::of(&engine, 0, Vec3::ZERO).expect("the body is dynamic");
    step(&mut engine, 1.0 / 240.0, 240);
    let after = Mechanics::of(&engine, 0, Vec3::ZERO).expect("the body is dynamic");
    let drift =
        (after.angular_momentum - before.angular_momentum).length() / before.angular_momentum.length();
    assert!(drift < 0.01, "angular momentum drifts by {drift}");
    assert!(
        (after.linear_momentum - before.linear_momentum).length() < 1e-6 * before.linear_momentum.length()
    );
    assert!((after.kinetic_energy / before.kinetic_energy - 1.0).abs() < 0.02);
    let turned = engine.state(0).angular_velocity.distance(state.angular_velocity);
    assert!(turned > 0.5, "a spin that stays put would mean that gyroscopic forces are off");
}

#[test]
fn mechanics_of_a_known_state() {
    let state = BodyState {
        linear_velocity: Vec3::new(0.0, 0.0, 2.0),
        angular_velocity: Vec3::new(0.0, 3.0, 0.0),
        ..at_rest(Vec3::new(1.0, 5.0, 0.0))
    };
    let found =
        Mechanics::new(4.0, DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)), &state, Vec3::NEG_Y * 10.0);
    assert_eq!(found.linear_momentum, DVec3::new(0.0, 0.0, 8.0));
    assert_eq!(found.angular_momentum, DVec3::new(40.0, -8.0 + 6.0, 0.0));
    assert_eq!((found.kinetic_energy, found.potential_energy), (8.0 + 9.0, 200.0));
    let fixed = engine(GRAVITY, &[body("floor", BodyKind::Fixed, Shape::Plane, Vec3::ZERO)]);
    assert_eq!(Mechanics::of(&fixed, 0, GRAVITY), None);
}
