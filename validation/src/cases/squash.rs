//! A cube that is compressed to 0.7 of its height between smooth plates.

use sorb::{
    World,
    glam::{DMat3, DVec3, UVec3, Vec3},
    scene::{Body, Motion, Scene, ShapeKind, Sponge, Time},
};

use super::bar::{EDGE, SOLVER_BOUND, even, settled};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    fem::Energy,
    solver::Material,
};

/// Compression far beyond small strain.
pub(super) static CASE: Case = Case {
    name: "squash",
    title: "a cube of foam is compressed to 0.7 of its height between smooth plates",
    source: "the uniform state of least energy; b = c^-nu, Poisson's ratio of the true strains",
    subject: Subject::Sponge,
    control: "Poisson's ratio 0.4 instead of 0.05",
    run,
};

/// A foam: its struts buckle, so that it hardly bulges.
const FOAM: Material = Material { young: 2e4, poisson: 0.05, density: 50.0 };
/// Height over that at rest; below it the cube buckles.
const PRESSED: f64 = 0.7;
/// Time in which the plates close \[s\].
const MOVES: f64 = 0.5;
/// Cells over the height.
const CELLS: u32 = 8;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let cells = even(setting, setting.pick(CELLS, CELLS / 2));
    let material = Material { poisson: setting.planted(FOAM.poisson, 0.4), ..FOAM };
    let scene = material.applied(&scene(cells), &setting.solvers)?;
    let mut world = setting.world(&scene)?;
    let measured = settled(setting, &mut world, MOVES + setting.pick(1.0, 0.5), 0.2)?;
    let found = width(&world, &measured);
    let minimum = equilibrium_width(&Energy::of(&FOAM, &setting.solvers));
    let foam = libm::pow(PRESSED, -FOAM.poisson);
    let name = |against: &str| format!("width over that at rest, against {against}");
    Ok(vec![
        Figure::relative(name("the energy of the solver"), "1", minimum, found, SOLVER_BOUND),
        Figure::relative(name("a foam"), "1", foam, found, 0.05),
    ])
}

/// Without gravity: only the plates act on the cube, and they do not hold it sideways.
fn scene(cells: u32) -> Scene {
    let half = 0.5 * f64::from(cells) * EDGE;
    let sponge = Sponge {
        edge: EDGE as f32,
        cells: UVec3::splat(cells),
        ..Sponge::new("cube", Vec3::splat(-half as f32))
    };
    let scene = Scene {
        gravity: Vec3::ZERO,
        time: Time { frame_rate: 200.0, ..Time::default() },
        ..Scene::new("squash")
    };
    let way = (1.0 - PRESSED) * half;
    let plate = |name: &str, sign: f64| {
        let thickness = 0.5 * EDGE;
        let shape =
            ShapeKind::Cuboid { half_extents: DVec3::new(2.0 * half, thickness, 2.0 * half).as_vec3() };
        let velocity = Vec3::Y * (-sign * way / MOVES) as f32;
        let motion = Motion::Linear { velocity, start: 0.0, end: MOVES as f32, ease: 0.0 };
        let place = Vec3::Y * (sign * (half + thickness)) as f32;
        Body { friction: 0.0, ..Body::kinematic(name, shape, place, vec![motion]) }
    };
    scene.with_sponge(sponge).with_body(plate("low", -1.0)).with_body(plate("high", 1.0))
}

/// Mean transverse stretch of all nodes: the slope of positions over positions at rest.
fn width(world: &World, places: &[DVec3]) -> f64 {
    let (mut product, mut square) = (0.0, 0.0);
    for (rest, place) in world.lattice().position.iter().zip(places) {
        let (x, z) = (f64::from(rest[0]), f64::from(rest[2]));
        product += x * place.x + z * place.z;
        square += x * x + z * z;
    }
    product / square
}

/// The transverse stretch without transverse stress, by bisection.
fn equilibrium_width(energy: &Energy) -> f64 {
    let stress =
        |width: f64| energy.gradient(&DMat3::from_diagonal(DVec3::new(width, PRESSED, width))).x_axis.x;
    let (mut low, mut high) = (0.1, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stress(middle) < 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}
