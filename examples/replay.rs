//! Records a scene with a push, saves it on the way, and plays the recording again: the same bits on other threads.
// Prints: ^120 frames, [0-9]+ bytes, the same digest on 1 thread: [0-9a-f]{16}$

use sorb::{
    Command, Options, Player, Recorder, Recording, World,
    glam::{UVec3, Vec3},
    scene::{Body, Scene, ShapeKind, Sponge},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ball = ShapeKind::Sphere { radius: 0.02 };
    let scene = Scene::new("bounce")
        .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.3, 0.1))
        .with_sponge(Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(-0.02, 0.0, -0.02)) })
        .with_body(Body::dynamic("ball", ball, Vec3::new(0.0, 0.12, 0.0), 1500.0));

    // A key frame every half second, to seek to.
    let mut world = World::new(&scene)?;
    let mut recorder = Recorder::new(&world, Some(30))?;
    let mut save = Vec::new();
    for frame in 0..120 {
        if frame == 40 {
            let (impulse, angular_impulse) = (Vec3::new(0.01, 0.05, 0.0), Vec3::ZERO);
            recorder.push(&mut world, Command::Impulse { body: 0.into(), impulse, angular_impulse })?;
        }
        if frame == 60 {
            world.save(&mut save)?;
        }
        recorder.advance_frame(&mut world)?;
    }

    // A file, or a message over the network.
    let mut bytes = Vec::new();
    recorder.into_recording().write(&mut bytes)?;

    // Another process compares every frame with the digest in the recording.
    let recording = Recording::read(&bytes[..])?;
    let one = Options { threads: Some(1), ..Options::default() };
    let mut player = Player::new(&recording, &one)?;
    while player.advance()? {}
    assert_eq!(player.world().digest(), world.digest());

    // It goes to any frame, and a save is that frame.
    player.seek(60)?;
    let restored = World::restore(&save[..], &one)?;
    assert_eq!(restored.digest(), player.world().digest());

    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        let (frames, size) = (recording.ticks(), bytes.len());
        println!("{frames} frames, {size} bytes, the same digest on 1 thread: {:016x}", world.digest());
    }
    Ok(())
}
