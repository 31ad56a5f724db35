//! States that are not finite stop a world, and the error names the row.

use super::*;

/// The error of a step over a state that was spoilt.
fn failure(name: &str, spoil: impl FnOnce(&mut Columns)) -> (World, Result<StepReport, StepError>) {
    let scene = crate::scene::preset(name).and_then(|scene| scene.scaled(0.5));
    let scene = scene.unwrap_or_else(|error| panic!("{error}"));
    let mut world = World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    assert!(world.step().is_ok());
    spoil(&mut world.stores.host);
    let result = world.step();
    (world, result)
}

#[test]
fn a_particle_that_is_not_finite_is_named_and_stops_the_world() {
    let (mut world, result) = failure("water", |columns| columns.fluid.velocity[5][1] = f32::NAN);
    let error = result.expect_err("the step must not go on");
    // The fault spreads within the step: the particle that is named is the spoilt one or a neighbour.
    let StepError::Particle { step, .. } = error else { panic!("{error}") };
    assert_eq!(step, 2);
    assert!(error.to_string().contains("is no longer finite"), "{error}");
    let digest = world.digest();
    assert_eq!(world.step(), Err(error));
    assert_eq!(world.digest(), digest, "a failed world must stay as it is");
    // The control: the same step without the fault.
    assert!(failure("water", |_| {}).1.is_ok());
}

#[test]
fn a_node_that_is_not_finite_is_named() {
    let (_, result) = failure("dry", |columns| columns.nodes.velocity[7][0] = f32::INFINITY);
    let error = result.expect_err("the step must not go on");
    assert!(matches!(error, StepError::Node { step: 2, .. }), "{error}");
    assert!(failure("dry", |_| {}).1.is_ok());
}
