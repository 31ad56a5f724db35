//! Bars that are stretched, confined and twisted.

use std::f64::consts::PI;

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Domain, Motion, Scene},
};

use super::bar::{Bar, FOAM, SOLVER_BOUND, against_elements, even, settled};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    fem::{Energy, Model},
    references::beam::torque,
    solver::Material,
};

/// Stretch with free sides.
pub(super) static UNIAXIAL: Case = Case {
    name: "uniaxial",
    title: "a bar is stretched by 5 %, its sides free",
    source: "converged elements on the same tets; F = E A e",
    subject: Subject::Sponge,
    control: "Poisson's ratio 0.4 instead of 0.2",
    run: |setting| run(setting, Kind::Uniaxial),
};

/// Compression between walls.
pub(super) static CONFINED: Case = Case {
    name: "confined",
    title: "a bar is compressed by 5 % between smooth walls",
    source: "converged elements on the same tets; F = M A e, M = lambda + 2 mu",
    subject: Subject::Sponge,
    control: "Poisson's ratio 0.4 instead of 0.2",
    run: |setting| run(setting, Kind::Confined),
};

/// Twist.
pub(super) static TORSION: Case = Case {
    name: "torsion",
    title: "a bar is twisted by a quarter turn over six thicknesses",
    source: "converged elements on the same tets; T = 0.1406 G b^4 theta / L",
    subject: Subject::Sponge,
    control: "Young's modulus a tenth too high",
    run: |setting| run(setting, Kind::Torsion),
};

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Uniaxial,
    Confined,
    Torsion,
}

/// Change of length over length.
const STRAIN: f64 = 0.05;
/// Turn of one end against the other \[rad\].
const TURN: f64 = 0.5;
/// Time in which the end is moved \[s\].
const MOVES: f64 = 0.5;
/// Cells over the thickness.
const THICKNESS: u32 = 8;

fn run(setting: &Setting, kind: Kind) -> Result<Vec<Figure>, Failure> {
    let thickness = even(setting, setting.pick(THICKNESS, THICKNESS / 2));
    let material = match kind {
        Kind::Torsion => Material { young: FOAM.young * setting.planted(1.0, 1.1), ..FOAM },
        _ => Material { poisson: setting.planted(FOAM.poisson, 0.4), ..FOAM },
    };
    let length = setting.pick(3, 4) * thickness;
    let bar = Bar { cells: UVec3::new(length, thickness, thickness), gravity: 0.0, material };
    let mut world = setting.world(&scene(&bar, setting, kind)?)?;
    let measured = settled(setting, &mut world, MOVES + setting.pick(2.5, 1.5), 0.5)?;
    let size = bar.size();
    let at_wall = |value: f64, high: f64| value < 1e-6 || value > high - 1e-6;
    let hold = |rest: DVec3| match kind {
        Kind::Confined => [false, at_wall(rest.y, size.y), at_wall(rest.z, size.z)],
        _ => [false; 3],
    };
    let (model, reference, figure) = against_elements(&world, setting, &FOAM, &measured, hold)?;
    let load = |model: &Model, positions: &[DVec3]| load(&bar, &world, model, positions, kind);
    let area = size.y.powi(2);
    let (what, unit, continuum) = match kind {
        Kind::Uniaxial => ("force", "N", FOAM.young * area * STRAIN),
        Kind::Confined => ("force", "N", FOAM.confined() * area * STRAIN),
        Kind::Torsion => ("torque", "N m", torque(&FOAM, size.y, TURN / size.x)),
    };
    // The load on the grip by the material of the simulator.
    let given = model.with_energy(Energy::of(&material, &setting.solvers));
    let (expected, found) = (load(&model, &reference), load(&given, &measured));
    Ok(vec![
        figure,
        Figure::relative(format!("{what} against elements"), unit, expected, found, SOLVER_BOUND),
        Figure::relative(format!("{what} against the continuum"), unit, continuum, found, 0.05),
    ])
}

fn scene(bar: &Bar, setting: &Setting, kind: Kind) -> Result<Scene, Failure> {
    let size = bar.size();
    let (start, end) = (0.0, MOVES as f32);
    let along = |way: f64| Motion::Linear { velocity: Vec3::X * (way / MOVES) as f32, start, end, ease: 0.0 };
    let motion = match kind {
        Kind::Uniaxial => along(STRAIN * size.x),
        Kind::Confined => along(-STRAIN * size.x),
        Kind::Torsion => Motion::Turn {
            axis: Vec3::X,
            pivot: (0.5 * size).as_vec3(),
            rate: (TURN / MOVES) as f32,
            start,
            end,
            ease: 0.0,
        },
    };
    let mut scene = bar.scene("bar", setting)?.with_body(bar.grip("right", size.x, vec![motion]));
    if kind == Kind::Confined {
        let ends = Vec3::X * size.x as f32;
        scene.domain = Domain::Box { minimum: -ends, maximum: size.as_vec3() + ends, periodic: [false; 3] };
        scene.sponges[0].friction = 0.0;
    }
    Ok(scene)
}

/// Load of the strained tets on the right grip \[N\] or \[N m\].
fn load(bar: &Bar, world: &World, model: &Model, positions: &[DVec3], kind: Kind) -> f64 {
    let forces = model.forces(positions);
    let axis = 0.5 * bar.size();
    let end = bar.section(world, bar.size().x);
    let of = |node: &usize| match kind {
        Kind::Torsion => (positions[*node] - axis).cross(forces[*node]).x,
        _ => forces[*node].x,
    };
    end.iter().map(of).sum::<f64>().abs()
}

/// A quarter turn at most: the references are for small strain.
const _: () = assert!(TURN < 0.5 * PI);
