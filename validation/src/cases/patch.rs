//! The patch test: if the surface moves affinely, the interior must follow.

use sorb::{
    World,
    glam::{DMat3, DVec3, UVec3, Vec3},
    scene::{Body, Motion, Scene, ShapeKind, Sponge, Time},
};

use super::bar::{EDGE, FOAM, settled};
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    fem::nodes,
    norms::root_mean_square,
};

/// Patch test.
pub(super) static CASE: Case = Case {
    name: "patch",
    title: "every node of the surface moves affinely, and the interior follows",
    source: "the affine map itself",
    subject: Subject::Sponge,
    control: "one node of the surface moved by a tenth of an edge",
    run,
};

/// Time in which the surface moves \[s\].
const MOVES: f64 = 0.2;

/// Displacement over position.
fn gradient() -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.03, 0.01, 0.0),
        DVec3::new(0.02, -0.02, 0.01),
        DVec3::new(0.0, 0.015, 0.025),
    )
}

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let cells = setting.pick(6, 4);
    let scene = scene(setting, cells)?;
    let mut world = setting.world(&scene)?;
    let (rest, surface) = (nodes(&world), held(&world));
    let inside: Vec<usize> = (0..rest.len()).filter(|node| !surface[*node]).collect();
    if inside.is_empty() {
        return Err(Failure::Nothing("no node is free".to_owned()));
    }
    let measured = settled(setting, &mut world, MOVES + 1.0, 0.1)?;
    let centre = DVec3::ZERO;
    let off = |node: &usize| {
        let affine = rest[*node] + gradient() * (rest[*node] - centre);
        (measured[*node] - affine).length() / EDGE
    };
    let largest = inside.iter().map(off).fold(0.0, f64::max);
    Ok(vec![
        Figure::error("way off the affine map over the edge, largest", "1", largest, 1e-5),
        Figure::error(
            "way off the affine map over the edge, RMS",
            "1",
            root_mean_square(inside.iter().map(off)),
            1e-5,
        ),
    ])
}

fn held(world: &World) -> Vec<bool> {
    world.node_positions().iter().map(|row| row[3] == 0.0).collect()
}

/// A small ball holds each node of the surface, and moves it along a straight line.
fn scene(setting: &Setting, cells: u32) -> Result<Scene, Failure> {
    let half = -0.5 * f64::from(cells) * EDGE;
    let sponge = Sponge {
        edge: EDGE as f32,
        cells: UVec3::splat(cells),
        ..Sponge::new("cube", DVec3::splat(half).as_vec3())
    };
    let bare = Scene {
        gravity: Vec3::ZERO,
        time: Time { frame_rate: 200.0, ..Time::default() },
        ..Scene::new("patch")
    }
    .with_sponge(sponge);
    let lattice = World::new(&bare)?.lattice().clone();
    let mut scene = bare;
    let surface = lattice.node_surface.iter().zip(&lattice.position).filter(|(surface, _)| **surface);
    // The fault is at a node that the interior is attached to: the one nearest to the centre.
    let distance = |row: &[f32; 4]| row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
    let nearest = surface.clone().map(|(_, row)| distance(row)).fold(f32::INFINITY, f32::min);
    let mut fault = Some(setting.planted(0.0, 0.1 * EDGE));
    for (index, (_, row)) in surface.enumerate() {
        let position = Vec3::new(row[0], row[1], row[2]);
        let mut way = gradient() * position.as_dvec3();
        if distance(row) <= nearest {
            way.x += fault.take().unwrap_or(0.0);
        }
        let motion =
            Motion::Linear { velocity: (way / MOVES).as_vec3(), start: 0.0, end: MOVES as f32, ease: 0.0 };
        let shape = ShapeKind::Sphere { radius: 1e-3 };
        let ball = Body::kinematic(&format!("ball{index}"), shape, position, vec![motion]);
        scene = scene.with_body(Body { grip: true, ..ball });
    }
    Ok(FOAM.applied(&scene, &setting.solvers)?)
}
