//! A host that owns its rapier3d world: shapes go in, wrenches come out, and every sub-step is told.
// Prints: ^after 2 s the crate floats [0-9.]+ mm above the floor, in [0-9]+ sub-steps$

use sorb::{
    Coupler, Options,
    glam::{Mat3, Vec3},
    rigid::{rapier3d::prelude::*, shape_of},
    scene::{Body, Fluid, FluidBlock, Scene},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // The world of the host: a floor, and a crate of half the density of water.
    let (mut bodies, mut colliders) = (RigidBodySet::new(), ColliderSet::new());
    colliders.insert(ColliderBuilder::new(SharedShape::halfspace(Vec3::Y)));
    let position = Vec3::new(0.0, 0.08, 0.0);
    let handle = bodies.insert(RigidBodyBuilder::dynamic().translation(position).can_sleep(false));
    let shape = SharedShape::cuboid(0.02, 0.012, 0.02);
    let collider = ColliderBuilder::new(shape.clone()).density(500.0);
    colliders.insert_with_parent(collider, handle, &mut bodies);
    let (mut pipeline, mut islands) = (PhysicsPipeline::new(), IslandManager::new());
    let (mut broad, mut narrow) = (BroadPhaseBvh::new(), NarrowPhase::new());
    let (mut joints, mut multibodies) = (ImpulseJointSet::new(), MultibodyJointSet::new());
    let (mut soft, mut swept) = (SoftBodySet::new(), CCDSolver::new());
    let mut parameters = IntegrationParameters { length_unit: 0.02, ..IntegrationParameters::default() };

    // The water: a scene with the shapes of the host.
    let (low, high) = (Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 0.12, 0.05));
    let water = FluidBlock::new(low, Vec3::new(0.05, 0.04, 0.05));
    let shape = shape_of(&shape).ok_or("a shape that scenes have not")?;
    let scene = Scene::new("crate")
        .in_box(low, high)
        .with_fluid(Fluid { blocks: vec![water], ..Fluid::default() })
        .with_body(Body::dynamic("crate", shape, position, 500.0));
    let mut coupler = Coupler::new(&scene, &Options::default())?;

    let mut steps = 0;
    for _ in 0..120 {
        steps += coupler.advance(1.0 / 60.0, |step| {
            let (own, told) = (&mut bodies[handle], &step.wrenches[0]);
            own.apply_impulse(told.impulse.as_vec3(), true);
            own.apply_torque_impulse(told.angular_impulse.as_vec3(), true);
            parameters.dt = step.length;
            pipeline.step(
                scene.gravity,
                &parameters,
                &mut islands,
                &mut broad,
                &mut narrow,
                &mut bodies,
                &mut colliders,
                &mut joints,
                &mut multibodies,
                &mut soft,
                &mut swept,
                &(),
                &(),
            );
            let (own, body) = (&bodies[handle], &mut step.bodies[0]);
            (body.state.position, body.state.rotation) = (own.translation(), *own.rotation());
            (body.state.linear_velocity, body.state.angular_velocity) = (own.linvel(), own.angvel());
            let mass = own.mass_properties();
            let m = mass.effective_world_inv_inertia;
            body.inverse_mass = mass.effective_inv_mass.x;
            body.inverse_inertia =
                Mat3::from_cols_array(&[m.m11, m.m12, m.m13, m.m12, m.m22, m.m23, m.m13, m.m23, m.m33]);
        })?;
    }
    let height = 1e3 * coupler.world().bodies()[0].state.position.y;
    assert!((25.0..60.0).contains(&height), "it floats at {height} mm");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("after 2 s the crate floats {height:.1} mm above the floor, in {steps} sub-steps");
    }
    Ok(())
}
