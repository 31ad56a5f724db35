//! Finite elements on the simulator's own tets, in f64, solved to convergence: the reference of the elastic solvers.
//!
//! Linear tets with an energy density of the deformation gradient, lumped masses, and held degrees of freedom.
//! [`Model::equilibrium`] is Newton's method with a sparse Cholesky factorisation (faer) and a line search on the energy.
//! [`Model::lowest_frequency`] is an inverse iteration with the same factors.

mod assembly;
mod energy;
mod modes;
mod newton;

pub use energy::Energy;

use sorb::{
    World,
    glam::{DMat3, DVec3},
};

use crate::case::Failure;

/// An elastic problem.
#[derive(Clone, Debug)]
pub struct Model {
    /// Positions at rest \[m\].
    pub rest: Vec<DVec3>,
    /// Nodes of the tets.
    pub tets: Vec<[usize; 4]>,
    /// Lumped masses \[kg\].
    pub mass: Vec<f64>,
    /// Energy of the material.
    pub energy: Energy,
    /// Acceleration that acts on all nodes \[m/s^2\].
    pub gravity: DVec3,
    /// Which coordinates of a node are held.
    pub held: Vec<[bool; 3]>,
    /// Gradients of the shape functions of every tet at rest \[1/m\].
    shapes: Vec<[DVec3; 4]>,
    /// Volumes that the tets stand for at rest \[m^3\].
    volumes: Vec<f64>,
}

impl Model {
    /// The sponges of a world at rest; nodes in grips are held.
    ///
    /// All sponges must have the same material.
    #[must_use]
    pub fn of(world: &World, energy: Energy) -> Self {
        let lattice = world.lattice();
        let rest: Vec<_> = lattice.position.iter().map(position).collect();
        let tets: Vec<_> = lattice.tets.iter().map(|tet| tet.map(|node| node as usize)).collect();
        let mass = lattice
            .node_volume
            .iter()
            .zip(&lattice.node_sponge)
            .map(|(volume, sponge)| {
                f64::from(*volume) * f64::from(world.scene().sponges[*sponge as usize].density)
            })
            .collect();
        let held = world.node_positions().iter().map(|row| [row[3] == 0.0; 3]).collect();
        let gravity = world.scene().gravity.as_dvec3();
        let mut model = Self::new(rest, tets, mass, energy, gravity, held);
        // The constraints of strain based dynamics use no tet weights.
        if !matches!(energy, Energy::Strain { .. }) {
            for (volume, weight) in model.volumes.iter_mut().zip(&lattice.tet_weight) {
                *volume *= f64::from(*weight);
            }
        }
        model
    }

    fn new(
        rest: Vec<DVec3>,
        tets: Vec<[usize; 4]>,
        mass: Vec<f64>,
        energy: Energy,
        gravity: DVec3,
        held: Vec<[bool; 3]>,
    ) -> Self {
        let (shapes, volumes) = tets.iter().map(|tet| shape(tet.map(|node| rest[node]))).unzip();
        Self { rest, tets, mass, energy, gravity, held, shapes, volumes }
    }

    /// The same problem with another energy.
    #[must_use]
    pub fn with_energy(&self, energy: Energy) -> Self {
        Self { energy, ..self.clone() }
    }

    /// Forces of the strained tets on all nodes, at given positions \[N\].
    #[must_use]
    pub fn forces(&self, positions: &[DVec3]) -> Vec<DVec3> {
        let mut forces = vec![DVec3::ZERO; positions.len()];
        for (index, tet) in self.tets.iter().enumerate() {
            let gradient = self.energy.gradient(&self.deformation(index, positions));
            for (node, shape) in tet.iter().zip(&self.shapes[index]) {
                forces[*node] -= gradient * *shape * self.volumes[index];
            }
        }
        forces
    }

    /// Deformation gradient of a tet.
    fn deformation(&self, tet: usize, positions: &[DVec3]) -> DMat3 {
        let mut sum = DMat3::ZERO;
        for (node, shape) in self.tets[tet].iter().zip(&self.shapes[tet]) {
            sum += outer(positions[*node], *shape);
        }
        sum
    }

    /// Elastic and potential energy at given positions \[J\].
    #[must_use]
    pub fn potential(&self, positions: &[DVec3]) -> f64 {
        let strain: f64 = (0..self.tets.len())
            .map(|tet| self.volumes[tet] * self.energy.density(&self.deformation(tet, positions)))
            .sum();
        let height: f64 = positions.iter().zip(&self.mass).map(|(x, mass)| mass * self.gravity.dot(*x)).sum();
        strain - height
    }
}

/// Root mean square distance of nodes from their reference positions, over that of their reference displacement.
#[must_use]
pub fn displacement_error(rest: &[DVec3], reference: &[DVec3], measured: &[DVec3]) -> f64 {
    let square =
        |a: &[DVec3], b: &[DVec3]| -> f64 { a.iter().zip(b).map(|(a, b)| (*a - *b).length_squared()).sum() };
    (square(reference, measured) / square(reference, rest)).sqrt()
}

/// Positions of the nodes of a world \[m\].
#[must_use]
pub fn nodes(world: &World) -> Vec<DVec3> {
    world.node_positions().iter().map(position).collect()
}

fn position(row: &[f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

/// Gradients of the shape functions, and the volume.
fn shape([p0, p1, p2, p3]: [DVec3; 4]) -> ([DVec3; 4], f64) {
    let edges = DMat3::from_cols(p1 - p0, p2 - p0, p3 - p0);
    let inverse = edges.inverse().transpose();
    let [a, b, c] = [inverse.x_axis, inverse.y_axis, inverse.z_axis];
    ([-(a + b + c), a, b, c], edges.determinant() / 6.0)
}

/// The failure of a solve.
fn failure(what: impl Into<String>) -> Failure {
    Failure::Reference(what.into())
}
