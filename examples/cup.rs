//! A cup: filled by a tap, tilted and emptied by its host, and nothing leaks through the wall.
// Prints: ^[0-9]+ g in the cup, [0-9]+ g left after it was turned over; lost: 0$

use sorb::{
    Command, World,
    glam::{Quat, Vec3},
    scene::{Body, Emitter, Fluid, Scene, ShapeKind},
};

/// Inner radius, height and thickness \[m\].
const SIZES: [f32; 3] = [0.03, 0.07, 0.008];

/// Mass of the water between underside and rim of the cup, and within its outer radius \[g\].
fn grams_inside(world: &World) -> f32 {
    let [radius, height, thickness] = SIZES;
    let state = world.bodies()[0].state;
    let inside = world.particle_positions().iter().filter(|row| {
        // The centre of mass is below the middle.
        let local = state.rotation.conjugate() * (Vec3::new(row[0], row[1], row[2]) - state.position);
        local.with_y(0.0).length() < radius + 0.5 * thickness && local.y.abs() < 0.6 * height
    });
    1e3 * inside.count() as f32 * world.particle_mass()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let [radius, height, thickness] = SIZES;
    let tap = Emitter {
        position: Vec3::new(0.0, 0.22, 0.0),
        velocity: Vec3::new(0.0, -0.6, 0.0),
        radius: 0.012,
        end: 0.4,
        ..Emitter::default()
    };
    let shape = ShapeKind::Cup { radius, height, thickness };
    let scene = Scene::new("cup")
        .in_box(Vec3::new(-0.12, 0.0, -0.08), Vec3::new(0.12, 0.24, 0.08))
        .with_fluid(Fluid::default())
        .with_emitter(tap)
        .with_body(Body::kinematic("cup", shape, Vec3::Y * 0.1, Vec::new()));
    let mut world = World::new(&scene)?;
    while world.clock().time < 1.0 {
        world.advance_frame()?;
    }
    let full = grams_inside(&world);

    // The host turns it over within a second: two poses, a quarter of a turn and more apart.
    let place = world.bodies()[0].state.position;
    for quarter in [1.0, 2.0] {
        let rotation = Quat::from_rotation_z(-1.3 * quarter);
        world.push(Command::Pose { body: 0.into(), position: place, rotation, duration: 0.5 })?;
        for _ in 0..30 {
            world.advance_frame()?;
        }
    }
    while world.clock().time < 2.8 {
        world.advance_frame()?;
    }
    let empty = grams_inside(&world);
    let ledger = world.ledger();
    assert!(full > 50.0 && empty < 0.1 * full, "{full} g, then {empty} g");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("{full:.0} g in the cup, {empty:.0} g left after it was turned over; lost: {}", ledger.lost);
    }
    Ok(())
}
