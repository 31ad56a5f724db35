//! A game loop: a hand follows a cursor, dips a sponge into a pool, and lets it go where the player says.
// Prints: ^The sponge has drunk [0-9]+ g, and lies at x = 0\.[0-9]+ m$

use sorb::{
    Command, Nodes, World,
    glam::{Quat, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge},
};

/// Where the player holds the cursor at a time \[s\]: from a sponge over a pool into it, out of it, and aside.
fn cursor(time: f64) -> Vec3 {
    let way = [
        (0.0, Vec3::new(-0.06, 0.125, 0.0)),
        (0.6, Vec3::new(-0.06, 0.045, 0.0)),
        (1.4, Vec3::new(-0.06, 0.045, 0.0)),
        (2.0, Vec3::new(-0.06, 0.14, 0.0)),
        (2.8, Vec3::new(0.09, 0.14, 0.0)),
    ];
    let next = way.iter().position(|(at, _)| *at > time).unwrap_or(way.len() - 1).max(1);
    let ((start, from), (end, to)) = (way[next - 1], way[next]);
    from.lerp(to, (((time - start) / (end - start)) as f32).clamp(0.0, 1.0))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (low, high) = (Vec3::new(-0.12, 0.0, -0.05), Vec3::new(0.14, 0.22, 0.05));
    let wall = ShapeKind::Cuboid { half_extents: Vec3::new(0.01, 0.04, 0.05) };
    let hand = ShapeKind::Sphere { radius: 0.012 };
    let sponge = Sponge {
        cells: UVec3::new(5, 3, 5),
        permeability: 5e-9,
        young_modulus: 2e4,
        ..Sponge::new("sponge", Vec3::new(-0.085, 0.085, -0.025))
    };
    let fluid =
        Fluid { blocks: vec![FluidBlock::new(low, Vec3::new(0.0, 0.05, high.z))], ..Fluid::default() };
    let scene = Scene::new("hand")
        .in_box(low, high)
        .with_fluid(fluid)
        .with_sponge(sponge)
        .with_body(Body::fixed("wall", wall, Vec3::new(0.01, 0.04, 0.0)))
        .with_body(Body { grip: true, ..Body::kinematic("hand", hand, cursor(0.0), Vec::new()) });
    let mut world = World::new(&scene)?;

    // The hand takes what it touches.
    let nodes = Nodes::Sphere { centre: cursor(0.0) - Vec3::Y * 0.01, radius: 0.02 };
    world.push(Command::Grip { body: 1.into(), nodes })?;
    let frame = 1.0 / f64::from(scene.time.frame_rate);
    while world.clock().time < 3.0 {
        // One pose a frame: the hand is there when the frame ends.
        let position = cursor(world.clock().time + frame);
        world.push(Command::Pose {
            body: 1.into(),
            position,
            rotation: Quat::IDENTITY,
            duration: frame as f32,
        })?;
        world.advance_frame()?;
    }
    let drunk = 1e3 * world.measures().absorbed_mass;
    // And lets go.
    let everything = Nodes::Sphere { centre: Vec3::ZERO, radius: 1.0 };
    world.push(Command::Release { nodes: everything })?;
    for _ in 0..30 {
        world.advance_frame()?;
    }
    let place = world.measures().sponge_centre.x;
    assert!(drunk > 10.0 && place > 0.06, "{drunk} g, {place} m");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("The sponge has drunk {drunk:.0} g, and lies at x = {place:.3} m");
    }
    Ok(())
}
