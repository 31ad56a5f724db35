//! A bar of sponge along x, held at its ends: common parts of the elastic cases.

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Motion, Scene, ShapeKind, Sponge, Time},
};

use crate::{
    case::{Failure, Figure, Setting},
    fem::{Energy, Model, displacement_error, nodes},
    solver::Material,
};

/// The material of the elastic cases: a soft foam.
pub(super) const FOAM: Material = Material { young: 2e4, poisson: 0.2, density: 50.0 };
/// Edge of a lattice cell \[m\].
pub(super) const EDGE: f64 = 0.01;
/// Largest error against converged finite elements.
pub(super) const SOLVER_BOUND: f64 = 5e-3;

/// A bar with its lowest corner in the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bar {
    /// Lattice cells along x, y and z.
    pub(super) cells: UVec3,
    /// Acceleration along y \[m/s^2\].
    pub(super) gravity: f64,
    /// Material.
    pub(super) material: Material,
}

impl Bar {
    /// Length, height and width \[m\].
    pub(super) fn size(&self) -> DVec3 {
        self.cells.as_dvec3() * EDGE
    }

    /// The scene, with a grip that holds the nodes of the left end.
    pub(super) fn scene(&self, name: &str, setting: &Setting) -> Result<Scene, Failure> {
        let sponge = Sponge { edge: EDGE as f32, cells: self.cells, ..Sponge::new("bar", Vec3::ZERO) };
        let scene = Scene {
            gravity: Vec3::new(0.0, self.gravity as f32, 0.0),
            time: Time { frame_rate: 200.0, ..Time::default() },
            ..Scene::new(name)
        };
        let scene = scene.with_sponge(sponge).with_body(self.grip("left", 0.0, Vec::new()));
        Ok(self.material.applied(&scene, &setting.solvers)?)
    }

    /// A grip on the nodes of a cross-section; it moves if it has motions.
    pub(super) fn grip(&self, name: &str, x: f64, motions: Vec<Motion>) -> Body {
        let size = self.size();
        let half = DVec3::new(0.1 * EDGE, 0.5 * size.y + EDGE, 0.5 * size.z + EDGE).as_vec3();
        let position = DVec3::new(x, 0.5 * size.y, 0.5 * size.z).as_vec3();
        let shape = ShapeKind::Cuboid { half_extents: half };
        let body = if motions.is_empty() {
            Body::fixed(name, shape, position)
        } else {
            Body::kinematic(name, shape, position, motions)
        };
        Body { grip: true, ..body }
    }

    /// Nodes of the cross-section at x at rest.
    pub(super) fn section(&self, world: &World, x: f64) -> Vec<usize> {
        let at = |row: &[f32; 4]| (f64::from(row[0]) - x).abs() < 0.1 * EDGE;
        let lattice = world.lattice();
        (0..lattice.node_count()).filter(|node| at(&lattice.position[*node])).collect()
    }
}

/// Positions of the nodes, mean over the last part of a run \[m\].
///
/// A remaining vibration about the equilibrium cancels in the mean to first order.
pub(super) fn settled(
    setting: &Setting,
    world: &mut World,
    seconds: f64,
    mean_over: f64,
) -> Result<Vec<DVec3>, Failure> {
    let mut sum = vec![DVec3::ZERO; world.node_positions().len()];
    let mut count = 0.0;
    while world.clock().time < seconds - 1e-6 {
        setting.advance(world)?;
        if world.clock().time > seconds - mean_over {
            sum.iter_mut().zip(nodes(world)).for_each(|(sum, position)| *sum += position);
            count += 1.0;
        }
    }
    Ok(sum.into_iter().map(|sum| sum / count).collect())
}

/// The equilibrium of the tets of a world, found from these positions, and the error of these positions.
pub(super) fn against_elements(
    world: &World,
    setting: &Setting,
    material: &Material,
    measured: &[DVec3],
    hold: impl Fn(DVec3) -> [bool; 3],
) -> Result<(Model, Vec<DVec3>, Figure), Failure> {
    let mut model = Model::of(world, Energy::of(material, &setting.solvers));
    for (held, rest) in model.held.iter_mut().zip(&model.rest) {
        let more = hold(*rest);
        *held = [0, 1, 2].map(|axis| held[axis] || more[axis]);
    }
    // Held nodes are at their held places; a wall holds a node at its place at rest.
    let mut guess = measured.to_vec();
    for ((guess, rest), row) in guess.iter_mut().zip(&model.rest).zip(world.node_positions()) {
        let more = hold(*rest);
        if row[3] > 0.0 {
            (0..3).filter(|axis| more[*axis]).for_each(|axis| guess[axis] = rest[axis]);
        }
    }
    let reference = model.equilibrium(&guess)?;
    let error = displacement_error(&model.rest, &reference, measured);
    let figure = Figure::error("displacement against converged elements, L2", "1", error, SOLVER_BOUND);
    Ok((model, reference, figure))
}

/// An even number of cells at the setting's resolution, so that the bar has a node on its axis.
pub(super) fn even(setting: &Setting, cells: u32) -> u32 {
    (setting.count(cells) / 2 * 2).max(2)
}
