//! Emitters and drains: as much as their rates say, from their start to their end.

use sorb::{
    Command, Options, World,
    glam::Vec3,
    scene::{Drain, Emitter, FluidSolver, Scene},
};

use super::{audit, busy_cup, common, cup, push};

/// A stream of 1 m/s into a cup.
fn tap() -> Emitter {
    let (position, velocity) = (Vec3::new(0.0, 0.13, 0.0), Vec3::new(0.0, -1.0, 0.0));
    Emitter { position, velocity, radius: 0.0126, ..Emitter::default() }
}

/// The floor of the cup.
fn floor() -> Drain {
    Drain {
        minimum: Vec3::new(-0.05, -0.01, -0.05),
        maximum: Vec3::new(0.05, 0.01, 0.05),
        ..Drain::default()
    }
}

fn frames(world: &mut World, count: u32) {
    (0..count).for_each(|_| common::frame(world));
    audit(world);
}

#[test]
fn an_emitter_brings_its_rate_from_its_start_to_its_end() {
    for solver in [FluidSolver::Divergence, FluidSolver::Wcsph] {
        let scene = cup(0.0, solver).with_emitter(Emitter { start: 0.05, end: 0.25, ..tap() });
        let mut world = common::world(&scene);
        frames(&mut world, 3);
        assert_eq!(world.ledger().poured, 0, "not yet");
        frames(&mut world, 7);
        let early = world.ledger().poured;
        frames(&mut world, 10);
        let ledger = world.ledger();
        let mass = ledger.poured as f32 * ledger.particle_mass;
        let expected = 1000.0 * std::f32::consts::PI * 0.0126 * 0.0126 * 0.2;
        assert!((mass / expected - 1.0).abs() < 0.1, "{solver:?}: {mass} kg of {expected}");
        assert!(early > ledger.poured / 3 && early < ledger.poured, "evenly: {early} of {}", ledger.poured);
        assert_eq!(world.emitters().count(), 0, "it has ended");
        frames(&mut world, 5);
        assert_eq!(world.ledger().poured, ledger.poured);
    }
}

#[test]
fn a_drain_takes_its_rate_and_not_more_than_there_is() {
    let rate = 0.2;
    let mut world = common::world(&cup(0.04, FluidSolver::Divergence).with_drain(Drain { rate, ..floor() }));
    frames(&mut world, 30);
    let ledger = world.ledger();
    let taken = ledger.drained as f32 * ledger.particle_mass;
    assert!((taken / (0.5 * rate) - 1.0).abs() < 0.02, "{taken} kg in 0.5 s");
    // Without a rate all that comes.
    let mut open = common::world(&cup(0.04, FluidSolver::Divergence).with_drain(floor()));
    frames(&mut open, 60);
    assert!(open.ledger().present < 20, "{:?}", open.ledger());
    // Negative control: a drain that opens later has taken nothing.
    let later = cup(0.04, FluidSolver::Divergence).with_drain(Drain { start: 10.0, ..floor() });
    let mut later = common::world(&later);
    frames(&mut later, 5);
    assert_eq!((later.ledger().drained, later.drains().count()), (0, 1));
}

#[test]
fn a_tap_over_a_drain_runs_on() {
    let scene = busy_cup(0.0, FluidSolver::Divergence).with_emitter(tap()).with_drain(floor());
    let mut world = common::world(&scene);
    frames(&mut world, 30);
    let half = world.ledger();
    frames(&mut world, 30);
    let ledger = world.ledger();
    assert!(ledger.drained > 300 && ledger.poured > half.poured + 300, "{ledger:?}");
    assert!(ledger.present < 2 * half.present, "it does not fill up: {half:?} {ledger:?}");
}

#[test]
fn flows_by_command_have_numbers_that_are_used_once() {
    let mut world = common::world(&cup(0.02, FluidSolver::Dfsph).with_drain(floor()));
    assert_eq!(world.next_flow().number(), 1);
    push(&mut world, Command::Emit { number: 1.into(), emitter: tap() });
    push(&mut world, Command::Drain { number: 2.into(), drain: floor() });
    assert_eq!(world.next_flow().number(), 3);
    let refused = |world: &mut World, command: Command, expected: &str| {
        let before = world.digest();
        let error = world.push(command).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(world.digest(), before);
    };
    refused(
        &mut world,
        Command::Emit { number: 2.into(), emitter: tap() },
        "`emit.number` = 2: no number is used twice; the next one is 3",
    );
    common::frame(&mut world);
    audit(&world);
    assert_eq!(world.emitters().map(|(flow, _)| flow.number()).collect::<Vec<_>>(), [1]);
    assert_eq!(world.drains().map(|(flow, _)| flow.number()).collect::<Vec<_>>(), [0, 2]);
    push(&mut world, Command::EndFlow { number: 1.into() });
    refused(
        &mut world,
        Command::EndFlow { number: 1.into() },
        "`end_flow.number` = 1: no such emitter or drain",
    );
    common::frame(&mut world);
    assert_eq!((world.emitters().count(), world.next_flow().number()), (0, 3));
    refused(&mut world, Command::EndFlow { number: 1.into() }, "it has ended, or never began");
    refused(&mut world, Command::EndFlow { number: 77.into() }, "no such emitter or drain");
    refused(&mut world, Command::Emit { number: 1.into(), emitter: tap() }, "the next one is 3");
    let emitter = |change: fn(&mut Emitter)| {
        let mut emitter = tap();
        change(&mut emitter);
        Command::Emit { number: 3.into(), emitter }
    };
    refused(
        &mut world,
        emitter(|own| own.radius = f32::NAN),
        "`emit.emitter.radius` = NaN is out of range 1e-4 to 10 m",
    );
    refused(&mut world, emitter(|own| own.velocity = Vec3::ZERO), "must be at least 0.01 m/s");
    refused(&mut world, emitter(|own| own.end = 0.0), "`emit.emitter.end` = 0: must be after");
    refused(&mut world, emitter(|own| own.end = 0.001), "must be after the present time");
    let drain = Drain { rate: -1.0, ..floor() };
    refused(
        &mut world,
        Command::Drain { number: 3.into(), drain },
        "`drain.drain.rate` = -1 is out of range 1e-6 to 1e6 kg/s",
    );
    let dry = &mut common::world(&Scene::new("space"));
    refused(dry, Command::Emit { number: 0.into(), emitter: tap() }, "the scene has no `fluid`");
}

#[test]
fn flows_go_on_after_a_restore() {
    let scene = busy_cup(0.01, FluidSolver::Dfsph)
        .with_emitter(Emitter { end: 0.2, ..tap() })
        .with_drain(Drain { rate: 0.1, ..floor() });
    let mut straight = common::world(&scene);
    let mut restored = common::world(&scene);
    for frame in 0..16 {
        common::frame(&mut straight);
        let mut bytes = Vec::new();
        restored.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        let options = Options { threads: Some(1 + frame % 3), ..Options::default() };
        restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut restored);
        assert_eq!(straight.digest(), restored.digest(), "frame {frame}");
    }
    audit(&straight);
    assert!(straight.ledger().drained > 0 && straight.emitters().count() == 0);
}

#[test]
fn scenes_with_bad_flows_are_refused() {
    let cup = cup(0.0, FluidSolver::Divergence);
    let refused = |scene: &Scene, expected: &str| {
        let error = World::new(scene).map(|_| ()).expect_err(expected).to_string();
        assert!(error.contains(expected), "{error}");
    };
    let nan = Emitter { position: Vec3::splat(f32::NAN), ..tap() };
    refused(
        &cup.clone().with_emitter(nan),
        "`emitters[0].position[0]` = NaN is out of range -1000 to 1000 m",
    );
    let inverted = Drain { maximum: Vec3::splat(-1.0), ..floor() };
    refused(
        &cup.clone().with_drain(inverted),
        "`drains[0].maximum` = [-1, -1, -1]: must be above `drains[0].minimum`",
    );
    refused(&Scene::new("dry").with_emitter(tap()), "`emitters` = 1: needs `fluid`");
    // As text they are the same.
    let scene = cup.with_emitter(tap()).with_drain(floor());
    let text = scene.to_toml().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(Scene::from_toml(&text, "text").ok(), Some(scene), "{text}");
}
