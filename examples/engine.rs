//! A host with its own physics: its engine moves the bodies, water and sponges push them.
// Prints: ^after 1 s the raft floats [0-9.]+ mm above the floor, and rolls back$

use glam::{Mat3, Vec3};
use sorb::{
    Options, World, glam,
    rigid::{BodyKind, BodySetup, BodyState, RigidEngine, RigidError, Wrench, body_setups},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind},
};

/// Bodies that fall and do not turn. A real one passes on to the engine of the host.
#[derive(Clone, Debug)]
struct Falling {
    states: Vec<BodyState>,
    masses: Vec<f32>,
}

impl Falling {
    fn new(bodies: &[BodySetup], mass: f32) -> Self {
        Self { states: bodies.iter().map(|body| body.state).collect(), masses: vec![mass; bodies.len()] }
    }
}

impl RigidEngine for Falling {
    fn body_count(&self) -> usize {
        self.states.len()
    }
    fn kind(&self, _index: usize) -> BodyKind {
        BodyKind::Dynamic
    }
    fn state(&self, index: usize) -> BodyState {
        self.states[index]
    }
    fn inverse_mass(&self, index: usize) -> f32 {
        1.0 / self.masses[index]
    }
    fn inverse_inertia(&self, _index: usize) -> Mat3 {
        Mat3::ZERO
    }
    fn step(&mut self, step: f32, wrenches: &[Wrench]) -> Result<(), RigidError> {
        for ((state, mass), wrench) in self.states.iter_mut().zip(&self.masses).zip(wrenches) {
            state.linear_velocity += wrench.impulse.as_vec3() / *mass + Vec3::NEG_Y * 9.81 * step;
            state.position += state.linear_velocity * step;
        }
        Ok(())
    }
    fn wait(&mut self, _time: f64) {}
    fn hold(&mut self, _index: usize, _is_held: bool) {}
    fn boxed_clone(&self) -> Box<dyn RigidEngine> {
        Box::new(self.clone())
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (low, high) = (Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 0.12, 0.05));
    let raft = ShapeKind::Cuboid { half_extents: Vec3::new(0.025, 0.01, 0.025) };
    let water = FluidBlock::new(low, Vec3::new(0.05, 0.04, 0.05));
    let scene = Scene::new("raft")
        .in_box(low, high)
        .with_fluid(Fluid { blocks: vec![water], ..Fluid::default() })
        .with_body(Body::dynamic("raft", raft, Vec3::new(0.0, 0.06, 0.0), 500.0));

    let engine = Falling::new(&body_setups(&scene)?, 500.0 * 0.05 * 0.02 * 0.05);
    let mut world = World::with_engine(&scene, Box::new(engine), &Options::default())?;
    for _ in 0..60 {
        world.advance_frame()?;
    }
    // Snapshots take a clone of the engine; saves and recordings need its `save` and `restore`.
    let mut snapshot = sorb::Snapshot::new();
    world.snapshot_into(&mut snapshot);
    world.advance_frame()?;
    world.rollback(&snapshot)?;
    let height = 1e3 * world.bodies()[0].state.position.y;
    assert!((20.0..60.0).contains(&height), "it floats at {height} mm");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("after 1 s the raft floats {height:.1} mm above the floor, and rolls back");
    }
    Ok(())
}
