//! Random valid scenes: no panic, finite, inside, no particle lost, and the same digest twice.

use proptest::{
    collection::vec,
    test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner},
};
use sorb::{
    Options, StepError, World, WorldError,
    glam::{UVec3, Vec3},
    scene::{self, BlockShape, Body, Fluid, FluidBlock, Motion, Rotation, Scene, ShapeKind, Sponge, limits},
    sponge::LatticeError,
};

use crate::{common, pick, scenes::BOX};

/// Steps of every scene.
const STEPS: u32 = 12;

/// A runner that draws the same on every machine and writes no files.
pub(crate) fn runner(cases: u32) -> TestRunner {
    let config = Config { cases, failure_persistence: None, max_shrink_iters: 200, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]))
}

/// Numbers from 0 to 1, used one after the other; missing ones are 0.
struct Draw<'a>(std::slice::Iter<'a, f32>);

impl Draw<'_> {
    fn unit(&mut self) -> f32 {
        self.0.next().copied().unwrap_or(0.0)
    }

    fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// Every decade has the same probability.
    fn decade(&mut self, low: f32, high: f32) -> f32 {
        libm::powf(10.0, self.between(libm::log10f(low), libm::log10f(high))).clamp(low, high)
    }

    /// One of `count` numbers.
    fn choice(&mut self, count: u32) -> u32 {
        (self.unit() * count as f32) as u32
    }

    fn vector(&mut self, size: f32) -> Vec3 {
        Vec3::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    /// A value in the range of a key: by decades, or zero where that is allowed.
    fn value(&mut self, key: &str) -> f32 {
        let limit = limits().find(|limit| limit.key == key);
        let limit = limit.unwrap_or_else(|| panic!("no key {key}"));
        if limit.minimum > 0.0 {
            return self.decade(limit.minimum, limit.maximum);
        }
        let value = self.decade(1e-6 * limit.maximum, limit.maximum);
        if self.unit() < 0.2 { 0.0 } else { value }
    }
}

fn fluid(draw: &mut Draw<'_>, spacing: f32) -> Fluid {
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    let high = Vec3::new(draw.between(-0.5, 1.0) * BOX, draw.between(0.1, 0.6) * BOX, BOX);
    let block = FluidBlock { velocity: draw.vector(10.0), ..FluidBlock::new(corner, high) };
    Fluid {
        spacing,
        rest_density: draw.value("fluid.rest_density"),
        support: draw.between(1.8, 3.0),
        density_tolerance: draw.value("fluid.density_tolerance"),
        rounds: 1 + draw.choice(60),
        viscosity: draw.value("fluid.viscosity"),
        artificial_viscosity: Some(draw.unit()),
        surface_tension: draw.value("fluid.surface_tension"),
        repulsion_damping: draw.unit(),
        solver: match draw.choice(8) {
            0 | 1 => Some(scene::FluidSolver::Wcsph),
            2 => Some(scene::FluidSolver::Pbf),
            3 => Some(scene::FluidSolver::Dfsph),
            _ => None,
        },
        projections: 1 + draw.choice(8),
        blocks: vec![block],
        ..Fluid::default()
    }
}

fn sponge(draw: &mut Draw<'_>, name: &str, spacing: f32, wet: bool) -> Sponge {
    // Three cells and the gap of a quarter of the box fit beside each other.
    let edge = (spacing * draw.between(1.0, 3.0)).min(0.3 * BOX);
    let cells = UVec3::new(2 + draw.choice(2), 2 + draw.choice(2), 2 + draw.choice(2));
    let x = if name == "left" { -BOX } else { 0.05 * BOX };
    let shape = match draw.choice(4) {
        0 => BlockShape::Ellipsoid,
        1 => BlockShape::Cylinder { axis: scene::Axis::Y },
        _ => BlockShape::Block,
    };
    // A shape cut out of two cells has only corners left.
    let shape = if cells.min_element() > 2 { shape } else { BlockShape::Block };
    let modulus = draw.value("sponges[].young_modulus");
    Sponge {
        edge,
        cells,
        shape,
        velocity: draw.vector(5.0),
        density: draw.value("sponges[].density"),
        porosity: draw.between(0.05, 0.99),
        permeability: draw.value("sponges[].permeability"),
        entry_pressure: draw.value("sponges[].entry_pressure"),
        suction_radius: draw.between(1.0, 2.5),
        saturation_gain: draw.between(0.0, 5.0),
        reaction: draw.between(0.0, 2.0),
        young_modulus: modulus,
        poisson_ratio: draw.between(0.0, 0.49),
        damping: draw.value("sponges[].damping"),
        stretch_modulus: modulus,
        shear_modulus: (0.5 * modulus).max(10.0),
        volume_modulus: modulus,
        solver: match draw.choice(6) {
            0 => scene::Solver::Sbd,
            1 => scene::Solver::XpbdNeoHookean,
            _ => scene::Solver::Vbd,
        },
        iterations: 1 + draw.choice(8),
        friction: draw.value("sponges[].friction"),
        saturation: if wet { draw.unit() } else { 0.0 },
        ..Sponge::new(name, Vec3::new(x, draw.between(0.0, 1.0) * BOX, draw.between(-0.9, 0.0) * BOX))
    }
}

fn body(draw: &mut Draw<'_>, name: &str) -> Body {
    let size = draw.decade(1e-3, 0.05);
    let shape = match draw.choice(4) {
        0 => ShapeKind::Sphere { radius: size },
        1 => ShapeKind::Cuboid { half_extents: Vec3::new(size, draw.decade(1e-3, 0.05), size) },
        2 => ShapeKind::Capsule { half_height: draw.between(0.0, 0.05), radius: size },
        _ => {
            let size = size.min(0.2 * BOX);
            let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z, Vec3::splat(0.7)];
            ShapeKind::Hull { vertices: corners.map(|corner| corner * size).to_vec() }
        }
    };
    // The centre of mass of a hull is not at its position, and must be inside as well.
    let wide = 0.8 * BOX;
    let place = Vec3::new(draw.between(-wide, wide), draw.between(0.2, 1.8) * BOX, draw.between(-wide, wide));
    let rotation = Rotation::new(Vec3::ONE, draw.between(-180.0, 180.0));
    let speed = 100.0 * draw_cube(draw);
    let (velocity, spin) = (draw.vector(speed), draw.vector(100.0));
    match draw.choice(3) {
        0 => Body {
            rotation,
            linear_velocity: velocity,
            angular_velocity: spin,
            restitution: draw.unit(),
            ..Body::dynamic(name, shape, place, draw.value("bodies[].density"))
        },
        1 => {
            let motions = vec![
                Motion::Linear { velocity, start: 0.0, end: 0.003, ease: 0.0 },
                Motion::Turn {
                    axis: Vec3::ONE,
                    pivot: place,
                    rate: spin.x,
                    start: 0.002,
                    end: 0.1,
                    ease: 0.0,
                },
            ];
            Body { rotation, ..Body::kinematic(name, shape, place, motions) }
        }
        _ => Body { rotation, grip: draw.choice(2) == 0, ..Body::fixed(name, shape, place) },
    }
}

/// From 0 to 1, mostly small.
fn draw_cube(draw: &mut Draw<'_>) -> f32 {
    draw.unit().powi(3)
}

/// A valid scene.
fn drawn(numbers: &[f32]) -> Scene {
    let mut draw = Draw(numbers.iter());
    let draw = &mut draw;
    let spacing = draw.between(0.006, 0.015);
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    let mut scene = Scene::new("drawn").in_box(corner, Vec3::new(BOX, 2.0 * BOX, BOX));
    scene.gravity = draw.vector(100.0) * draw_cube(draw);
    scene.time.maximum_step = draw.value("time.maximum_step");
    scene.time.minimum_step = 1e-9;
    scene.time.courant = draw.between(0.05, 1.0);
    let wet = draw.choice(5) > 0;
    if wet {
        scene = scene.with_fluid(fluid(draw, spacing));
    }
    let sponges = draw.choice(3) as usize;
    for name in ["left", "right"].into_iter().take(sponges) {
        scene = scene.with_sponge(sponge(draw, name, spacing, wet));
    }
    for name in ["one", "two", "three"].into_iter().take(draw.choice(4) as usize) {
        let mut body = body(draw, name);
        body.grip &= !scene.sponges.is_empty();
        scene = scene.with_body(body);
    }
    if sponges == 0 {
        repeat(&mut scene, draw);
    }
    scene
}

/// Makes some axes periodic where the scene is long enough: its water then fills a whole number of spacings.
fn repeat(scene: &mut Scene, draw: &mut Draw<'_>) {
    let mut axes = [0; 3].map(|_| draw.choice(3) == 0);
    if let Some(fluid) = &mut scene.fluid {
        fluid.spacing = 2.0 * BOX / (2.0 * BOX / fluid.spacing).round();
        let is_short = 2.0 * fluid.neighbor_radius() >= 1.9 * BOX;
        axes = axes.map(|axis| axis && !is_short);
    }
    *scene = std::mem::take(scene).repeating(axes);
}

/// Runs a scene and returns its digest; refusing a step that would be too small is no fault.
fn digest(scene: &Scene, threads: usize) -> Result<u64, TestCaseError> {
    let fail = |what: String| TestCaseError::fail(what);
    let options = Options { threads: Some(threads), ..Options::default() };
    let mut world = World::with_options(scene, &options).map_err(|error| match error {
        // A body may take up all of a sponge around it.
        WorldError::Lattice(LatticeError::Empty { .. }) => TestCaseError::reject("no sponge is left"),
        error => fail(error.to_string()),
    })?;
    let (particles, mass) = (world.particle_ids().len(), world.measures().water_mass);
    for step in 1..=STEPS {
        match world.step() {
            Ok(_) => {}
            Err(StepError::TooSmall { .. }) => break,
            Err(error) => return Err(fail(error.to_string())),
        }
        if let Some(what) = common::unhealthy(&world, particles) {
            return Err(fail(format!("step {step}: {what}")));
        }
    }
    let measures = world.measures();
    if measures.water_mass.to_bits() != mass.to_bits() {
        return Err(fail(format!("{mass} kg of water, then {} kg", measures.water_mass)));
    }
    if !(measures.kinetic_energy + measures.elastic_energy + measures.mean_density_error).is_finite() {
        return Err(fail(format!("{measures:?}")));
    }
    Ok(world.digest())
}

#[test]
fn scenes_at_random_stay_whole_and_come_out_twice_the_same() {
    let result = runner(pick(60, 3000)).run(&vec(0.0_f32..1.0, 120), |numbers| {
        let scene = drawn(&numbers);
        let first = digest(&scene, 1)?;
        let second = digest(&scene, 2)?;
        if first == second {
            Ok(())
        } else {
            Err(TestCaseError::fail(format!("digests {first:016x} and {second:016x}")))
        }
    });
    if let Err(failure) = result {
        let text = match &failure {
            proptest::test_runner::TestError::Fail(why, numbers) => {
                format!("{why}\n{}", drawn(numbers).to_toml().unwrap_or_default())
            }
            other => other.to_string(),
        };
        panic!("{text}");
    }
}

/// Negative control: the draws reach water, sponges and bodies of every kind, alone and together.
#[test]
fn the_draws_are_of_all_kinds() {
    let mut seen = std::collections::BTreeSet::new();
    let result = runner(200).run(&vec(0.0_f32..1.0, 120), |_| Ok(()));
    assert!(result.is_ok());
    let (mut runner, mut repeating) = (runner(0), 0);
    for _ in 0..200 {
        let tree = proptest::strategy::Strategy::new_tree(&vec(0.0_f32..1.0, 120), &mut runner);
        let tree = tree.unwrap_or_else(|reason| panic!("{reason}"));
        let scene = drawn(&proptest::strategy::ValueTree::current(&tree));
        seen.insert((scene.fluid.is_some(), scene.sponges.len(), scene.bodies.len()));
        repeating += u32::from(scene.fluid.is_some() && scene.periodic().contains(&true));
        assert_eq!(scene.problems(), [], "not valid");
    }
    assert_eq!(seen.len(), 2 * 3 * 4, "{seen:?}");
    assert!(repeating > 10, "{repeating} scenes with water that repeats");
}
