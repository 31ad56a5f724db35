//! A tap and a drain: a stream fills a basin, the plug is pulled, and the books balance to the particle.
// Prints: ^[0-9]+ g came in, [0-9]+ g ran out, [0-9]+ g are left, [0-9.]+ mm deep; lost: 0$

use sorb::{
    Command, World,
    glam::Vec3,
    scene::{Drain, Emitter, Fluid, FluidSolver, Scene},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (low, high) = (Vec3::new(-0.06, 0.0, -0.06), Vec3::new(0.06, 0.16, 0.06));
    let fluid = Fluid { solver: Some(FluidSolver::Divergence), ..Fluid::default() };
    let tap = Emitter {
        position: Vec3::new(-0.03, 0.12, 0.0),
        velocity: Vec3::new(0.0, -0.6, 0.0),
        radius: 0.012,
        end: 1.5,
        ..Emitter::default()
    };
    // The basin is empty: it has a fluid, and no block of it.
    let scene = Scene::new("basin").in_box(low, high).with_fluid(fluid).with_emitter(tap);
    let mut world = World::new(&scene)?;
    world.reserve_particles(10_000);

    // The host is a game: it looks at the level, and pulls the plug once.
    let mut plug = None;
    while world.clock().time < 2.5 {
        world.advance_frame()?;
        let level = world.water_levels(&[[0.03, 0.0]])?[0].unwrap_or(0.0);
        if plug.is_none() && level > 0.015 {
            let number = world.next_flow();
            let corner = Vec3::new(0.03, 0.0, -0.03);
            let drain = Drain {
                minimum: corner,
                maximum: corner + Vec3::new(0.03, 0.01, 0.06),
                rate: 0.2,
                ..Drain::default()
            };
            world.push(Command::Drain { number, drain })?;
            plug = Some(number);
        }
    }
    let number = plug.ok_or("the basin never filled")?;
    world.push(Command::EndFlow { number })?;
    for _ in 0..30 {
        world.advance_frame()?;
    }
    // A number is used once.
    assert!(world.push(Command::EndFlow { number }).is_err());

    let ledger = world.ledger();
    assert_eq!(ledger.poured, ledger.drained + ledger.present);
    let grams = |particles: u64| 1e3 * particles as f32 * ledger.particle_mass;
    let level = 1e3 * world.water_levels(&[[-0.03, 0.03]])?[0].unwrap_or(0.0);
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!(
            "{:.0} g came in, {:.0} g ran out, {:.0} g are left, {level:.1} mm deep; lost: {}",
            grams(ledger.poured),
            grams(ledger.drained),
            grams(ledger.present),
            ledger.lost
        );
    }
    Ok(())
}
