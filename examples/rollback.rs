//! Netcode in small: the push of the other player arrives four frames late. The host rolls back, plays the frames again
//! with the push, and has the state of a host that knew it in time.
// Prints: ^rolled back [0-9]+ times, and ended as if nothing had been late$

use sorb::{
    Command, Snapshot, World,
    glam::{UVec3, Vec3},
    scene::{Body, Scene, ShapeKind, Sponge},
};

/// Frames that a message takes.
const LATE: usize = 4;
const FRAMES: usize = 60;

/// What the other player does before a frame.
fn push(frame: usize) -> Option<Command> {
    let impulse = Vec3::new(0.02, 0.0, 0.0);
    (frame % 15 == 5).then_some(Command::Impulse { body: 0.into(), impulse, angular_impulse: Vec3::ZERO })
}

fn advance(world: &mut World, command: Option<Command>) -> Result<(), Box<dyn std::error::Error>> {
    if let Some(command) = command {
        world.push(command)?;
    }
    world.advance_frame()?;
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ball = ShapeKind::Sphere { radius: 0.015 };
    let scene = Scene::new("push")
        .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1))
        .with_sponge(Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(0.0, 0.0, -0.02)) })
        .with_body(Body::dynamic("ball", ball, Vec3::new(-0.05, 0.02, 0.0), 2000.0));

    // This host knows every push in time.
    let mut world = World::new(&scene)?;
    for frame in 0..FRAMES {
        advance(&mut world, push(frame))?;
    }

    // This one hears of it four frames later. Its snapshots are filled again and again.
    let mut late = World::new(&scene)?;
    let mut snapshots: [Snapshot; LATE + 1] = Default::default();
    let mut rolled_back = 0;
    for frame in 0..FRAMES + LATE {
        let first = frame.saturating_sub(LATE);
        if frame >= LATE && push(first).is_some() {
            late.rollback(&snapshots[first % (LATE + 1)])?;
            rolled_back += 1;
            for again in first..frame.min(FRAMES) {
                late.snapshot_into(&mut snapshots[again % (LATE + 1)]);
                advance(&mut late, push(again).filter(|_| again == first))?;
            }
        }
        if frame < FRAMES {
            late.snapshot_into(&mut snapshots[frame % (LATE + 1)]);
            advance(&mut late, None)?;
        }
    }
    assert_eq!(late.digest(), world.digest());
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!("rolled back {rolled_back} times, and ended as if nothing had been late");
    }
    Ok(())
}
