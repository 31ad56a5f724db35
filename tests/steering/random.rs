//! Random sequences of all commands: an error or a sound world, and one digest whatever happens in between.

use sorb::{
    BodyHandle, Command, Nodes, Options, Player, Recorder, Region, SimdLevel, Snapshot, SpongeHandle, World,
    glam::{Quat, UVec3, Vec3},
    rigid::BodyKind,
    scene::{Body, Drain, Emitter, FluidSolver, GravityKey, Material, Motion, Scene, ShapeKind, Sponge},
};

use super::{audit, common::random::Random, pool, push};

const FRAMES: u64 = 8;

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.next() % count
    }
    fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }
    /// In the container, or a little outside.
    fn point(&mut self) -> Vec3 {
        Vec3::new(0.07 * self.signed(), 0.17 * self.unit(), 0.07 * self.signed())
    }
    fn turn(&mut self) -> Quat {
        Quat::from_rotation_y(self.signed()) * Quat::from_rotation_x(self.signed())
    }
    /// A body that was there at some time, or may be some day.
    fn body(&mut self, world: &World) -> BodyHandle {
        let all: Vec<BodyHandle> = world.body_handles().chain([world.next_body(), 9.into()]).collect();
        all[self.below(all.len() as u64) as usize]
    }
    /// A sponge that was there at some time, or may be some day.
    fn sponge(&mut self, world: &World) -> SpongeHandle {
        let all: Vec<SpongeHandle> = world.sponge_handles().chain([world.next_sponge(), 1.into()]).collect();
        all[self.below(all.len() as u64) as usize]
    }
}

/// A command to bodies, good or bad.
fn to_bodies(random: &mut Random, world: &World, seed: u64) -> Command {
    let (body, place) = (random.body(world), random.point());
    let vector = Vec3::new(random.signed(), random.signed(), random.signed());
    match random.below(8) {
        0 => Command::Force { body, force: 0.2 * vector, torque: 1e-4 * vector },
        1 => Command::Impulse { body, impulse: 2e-3 * vector, angular_impulse: 1e-6 * vector },
        2 => Command::Velocity { body, linear_velocity: vector, angular_velocity: 5.0 * vector },
        3 => Command::Pose {
            body,
            position: place,
            rotation: random.turn(),
            duration: 0.05 + 0.2 * random.unit(),
        },
        4 => Command::RemoveBody { body },
        5 => {
            let kinds = [BodyKind::Dynamic, BodyKind::Fixed, BodyKind::Kinematic];
            Command::BodyKind { body, kind: kinds[random.below(3) as usize] }
        }
        _ => {
            let shape = match random.below(3) {
                0 => ShapeKind::Sphere { radius: 0.006 + 0.01 * random.unit() },
                1 => ShapeKind::Cuboid { half_extents: Vec3::splat(0.006) + 0.004 * vector.abs() },
                _ => ShapeKind::Capsule { half_height: 0.01, radius: 0.008 },
            };
            let name = format!("body{}_{}", seed, random.below(1_000_000));
            let density = 200.0 + 3000.0 * random.unit();
            let description =
                Box::new(Body { linear_velocity: vector, ..Body::dynamic(&name, shape, place, density) });
            Command::AddBody { body: world.next_body(), description }
        }
    }
}

/// A command to water, good or bad.
fn to_water(random: &mut Random, world: &World) -> Command {
    let (point, other, radius) = (random.point(), random.point(), 0.005 + 0.02 * random.unit());
    let region = match random.below(3) {
        0 => Region::Sphere { centre: point, radius },
        1 => Region::Cylinder { start: point, end: other, radius },
        _ => Region::Box { minimum: point.min(other), maximum: point.max(other) },
    };
    let (number, end) = (world.next_flow(), world.clock().time as f32 + 0.1 * random.unit());
    let velocity = Vec3::new(random.signed(), -1.0, random.signed());
    match random.below(6) {
        0 | 1 => Command::Pour { region, velocity },
        2 => Command::Remove { region },
        3 => {
            let emitter =
                Emitter { position: point, velocity, radius: 0.4 * radius, end, ..Emitter::default() };
            Command::Emit { number, emitter }
        }
        4 => {
            let (minimum, maximum) = (point.min(other), point.max(other));
            Command::Drain { number, drain: Drain { minimum, maximum, rate: 0.2, end, ..Drain::default() } }
        }
        _ => Command::EndFlow { number: number.number().saturating_sub(1).into() },
    }
}

/// A command to sponges, good or bad.
fn to_sponges(random: &mut Random, world: &World) -> Command {
    let (sponge, position, velocity) = (random.sponge(world), random.point(), Vec3::X * random.signed());
    let nodes = Nodes::Sphere { centre: random.point(), radius: 0.005 + 0.02 * random.unit() };
    match random.below(8) {
        5 => Command::RemoveSponge { sponge },
        6 | 7 => {
            let name = format!("sponge{}", random.below(1_000_000));
            let saturation = 0.5 * random.below(3) as f32;
            let cells = UVec3::new(2, 2 + random.below(2) as u32, 3);
            let description =
                Box::new(Sponge { cells, velocity, saturation, ..Sponge::new(&name, position) });
            Command::AddSponge { sponge: world.next_sponge(), description }
        }
        0 | 1 => Command::PlaceSponge { sponge, position, rotation: random.turn(), velocity },
        2 => Command::Grip { body: random.body(world), nodes },
        3 => Command::Release { nodes },
        _ => {
            let material = Material {
                density: 30.0 + 60.0 * random.unit(),
                porosity: 0.7 + 0.25 * random.unit(),
                permeability: 1e-9 + 5e-9 * random.unit(),
                young_modulus: 4000.0 + 2e4 * random.unit(),
                poisson_ratio: 0.5 * random.unit(),
                entry_pressure: 500.0 * random.unit(),
                softening: 0.5 * random.below(2) as f32,
                swelling: 0.1 * random.below(2) as f32,
                iterations: random.below(7) as u32,
                ..Material::default()
            };
            Command::Material { sponge, material }
        }
    }
}

/// A command to everything, good or bad.
fn to_all(random: &mut Random, world: &World) -> Command {
    let now = world.clock().time as f32 + 1e-4;
    let vector = Vec3::new(random.signed(), random.signed(), random.signed());
    let (start, end, ease) = (now, now + 0.1, 0.05 * random.unit());
    match random.below(4) {
        0 => Command::Gravity { gravity: Vec3::NEG_Y * 9.0 + vector },
        1 => {
            let key = |time: f32, gravity: Vec3| GravityKey { time, gravity };
            Command::GravityPath { path: vec![key(now, 5.0 * vector), key(end, Vec3::NEG_Y * 9.81)] }
        }
        2 => {
            let turn = Motion::Turn { axis: vector, pivot: Vec3::ZERO, rate: 2.0, start, end, ease };
            Command::Container { motions: vec![turn] }
        }
        _ => {
            let shake = Motion::Shake { amplitude: 0.01 * vector, frequency: 5.0, start, end, ease };
            Command::Container { motions: vec![shake] }
        }
    }
}

/// The commands before a frame, which are functions of seed, frame and the state alone.
fn commands(world: &World, seed: u64, frame: u64) -> Vec<Command> {
    let mut random = Random(seed.wrapping_mul(1000) + frame);
    let command = |random: &mut Random| match random.below(4) {
        0 => to_bodies(random, world, seed),
        1 => to_water(random, world),
        2 => to_sponges(random, world),
        _ => to_all(random, world),
    };
    (0..random.below(4)).map(|_| command(&mut random)).collect()
}

/// Takes a frame; returns how many commands were taken and how many refused.
fn advance(world: &mut World, seed: u64, frame: u64) -> [u32; 2] {
    let mut counts = [0; 2];
    let commands = commands(world, seed, frame);
    for command in commands.clone() {
        let before = world.digest();
        let is_refused = world.push(command).is_err();
        counts[usize::from(is_refused)] += 1;
        assert!(!is_refused || world.digest() == before, "a refused command changes nothing");
    }
    world.advance_frame().unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
    let is_sound = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| audit(world)));
    assert!(is_sound.is_ok(), "seed {seed}, frame {frame}, after {commands:?}");
    counts
}

/// A pool; from the seed 10000 on seven of eight are coarse, so that many can be tried.
fn scene(seed: u64) -> Scene {
    let solvers = [FluidSolver::Divergence, FluidSolver::Dfsph, FluidSolver::Pbf];
    let mut scene = pool();
    if let Some(fluid) = &mut scene.fluid {
        fluid.solver = Some(solvers[(seed % 3) as usize]);
        if seed >= 10_000 && !seed.is_multiple_of(8) {
            fluid.spacing = 0.01;
        }
    }
    if seed % 2 == 1 {
        (scene.time.sleep_after, scene.time.sleep_speed) = (0.03, 0.5);
    }
    scene
}

fn options(threads: usize, simd: SimdLevel) -> Options {
    Options { threads: Some(threads), simd: Some(simd), ..Options::default() }
}

fn world(seed: u64, threads: usize, simd: SimdLevel) -> World {
    World::with_options(&scene(seed), &options(threads, simd)).unwrap_or_else(|error| panic!("{error}"))
}

fn straight(seed: u64, threads: usize, simd: SimdLevel) -> (u64, [u32; 2]) {
    let (mut own, mut counts) = (world(seed, threads, simd), [0; 2]);
    for frame in 0..FRAMES {
        let [taken, refused] = advance(&mut own, seed, frame);
        counts = [counts[0] + taken, counts[1] + refused];
    }
    (own.digest(), counts)
}

/// Saved and restored before every frame, with commands that wait.
fn restored(seed: u64) -> u64 {
    let mut own = world(seed, 1, SimdLevel::Fallback);
    for frame in 0..FRAMES {
        for command in commands(&own, seed, frame) {
            let _ = own.push(command);
        }
        let mut bytes = Vec::new();
        own.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        let options = options(1 + frame as usize % 3, SimdLevel::best());
        own = World::restore(&bytes[..], &options)
            .unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
        own.advance_frame().unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
    }
    own.digest()
}

/// Every frame twice, with other commands the first time.
fn rolled_back(seed: u64) -> u64 {
    let (mut own, mut snapshot) = (world(seed, 2, SimdLevel::best()), Snapshot::new());
    for frame in 0..FRAMES {
        own.snapshot_into(&mut snapshot);
        advance(&mut own, seed + 77, frame);
        own.rollback(&snapshot).unwrap_or_else(|error| panic!("seed {seed}, frame {frame}: {error}"));
        advance(&mut own, seed, frame);
    }
    own.digest()
}

fn replayed(seed: u64) -> u64 {
    let mut own = world(seed, 2, SimdLevel::best());
    let mut recorder = Recorder::new(&own, Some(3)).unwrap_or_else(|error| panic!("{error}"));
    for frame in 0..FRAMES {
        for command in commands(&own, seed, frame) {
            let _ = recorder.push(&mut own, command);
        }
        recorder.advance_frame(&mut own).unwrap_or_else(|error| panic!("{error}"));
    }
    let recording = recorder.into_recording();
    let one = options(1, SimdLevel::Fallback);
    let mut player = Player::new(&recording, &one).unwrap_or_else(|error| panic!("{error}"));
    while player.advance().unwrap_or_else(|error| panic!("seed {seed}: {error}")) {}
    assert_eq!(player.world().digest(), own.digest());
    player.seek(FRAMES - 2).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
    assert!(player.advance().unwrap_or_else(|error| panic!("seed {seed}: {error}")));
    own.digest()
}

fn one_digest(seed: u64) {
    let (first, counts) = straight(seed, 1, SimdLevel::Fallback);
    for (threads, simd) in [(2, SimdLevel::best()), (3, SimdLevel::Fallback), (2, SimdLevel::best())] {
        assert_eq!(straight(seed, threads, simd).0, first, "seed {seed}: {threads} threads, {simd}");
    }
    assert_eq!(restored(seed), first, "seed {seed}: restored");
    assert_eq!(rolled_back(seed), first, "seed {seed}: rolled back");
    assert_eq!(replayed(seed), first, "seed {seed}: replayed");
    assert!(counts[0] > 2, "seed {seed}: {counts:?} commands taken and refused");
    assert_ne!(straight(seed + 6, 2, SimdLevel::best()).0, first, "negative control: other commands");
}

macro_rules! matrix {
    ($($name:ident: $seed:literal;)+) => {
        $(#[test]
        fn $name() {
            one_digest($seed);
        })+
    };
}
matrix! {
    one_digest_with_the_solve_for_the_divergence: 3006;
    one_digest_with_the_solve_for_the_density_and_sleep: 3007;
    one_digest_with_projections: 3008;
}

/// Sequences that have failed once, by their seeds.
const FAILED_ONCE: &[u64] = &[11_468, 13_007, 16_721, 17_252, 19_538, 21_006];

/// Sequences of 100 000 that still fail, both with `divergence`: `docs/stress.md` says how.
const KNOWN_FAULTS: &[u64] = &[83_385, 114_549];

/// Seeds that are tried: 24 and those that have failed once; with `SORB_STRESS=1` many more. `SORB_SEEDS=4000..104000` tries those, and
/// goes on after failures to name all of them.
fn seeds() -> Vec<u64> {
    let Ok(asked) = std::env::var("SORB_SEEDS") else {
        let last = if std::env::var_os("SORB_STRESS").is_some() { 6000 } else { 4024 };
        return (4000..last).chain(FAILED_ONCE.iter().copied()).collect();
    };
    let number =
        |text: &str| text.trim().parse().unwrap_or_else(|error| panic!("SORB_SEEDS = {asked}: {error}"));
    let (first, end) = asked.split_once("..").unwrap_or_else(|| panic!("SORB_SEEDS = {asked}: FIRST..END"));
    let asked = number(first)..number(end);
    let is_one = asked.end == asked.start + 1;
    asked.filter(|seed| is_one || !KNOWN_FAULTS.contains(seed)).collect()
}

/// Counts of commands taken and refused in a sequence; none if it failed, with what has been printed.
fn tried(seed: u64) -> Option<[u32; 2]> {
    let result = std::panic::catch_unwind(|| straight(seed, 1, SimdLevel::best()));
    result.ok().map(|(_, counts)| counts)
}

#[test]
#[expect(clippy::print_stdout, reason = "figures of the documentation")]
fn any_commands_give_an_error_or_a_sound_world() {
    let (seeds, mut counts, mut failed) = (seeds(), [0; 2], Vec::new());
    for seed in &seeds {
        match tried(*seed) {
            Some([taken, refused]) => counts = [counts[0] + taken, counts[1] + refused],
            None => failed.push(*seed),
        }
    }
    println!("{} sequences, {counts:?} commands taken and refused, failed: {failed:?}", seeds.len());
    assert_eq!(failed, Vec::<u64>::new(), "SORB_SEEDS={}..{}", failed[0], failed[0] + 1);
    // Both happen often.
    assert!(seeds.len() < 10 || counts.iter().all(|count| *count as usize > seeds.len()), "{counts:?}");
}

/// Whoever corrects them takes them over into those that have failed once.
#[test]
fn known_faults_are_still_there() {
    for seed in KNOWN_FAULTS {
        assert_eq!(tried(*seed), None, "seed {seed} is sound");
    }
}

/// Negative control: a sequence after which the world is not sound is noticed.
#[test]
fn a_world_that_is_not_sound_is_noticed() {
    let mut own = world(3006, 1, SimdLevel::best());
    audit(&own);
    let body = own.body_handles().next().unwrap_or_else(|| panic!("a ball"));
    push(&mut own, Command::Velocity { body, linear_velocity: Vec3::Y * 90.0, angular_velocity: Vec3::ZERO });
    push(
        &mut own,
        Command::Pour {
            region: Region::Sphere { centre: Vec3::Y * 0.08, radius: 0.01 },
            velocity: Vec3::Y * 40.0,
        },
    );
    let is_sound = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        own.step().unwrap_or_else(|error| panic!("{error}"));
        audit(&own);
    }));
    assert!(is_sound.is_err());
}
