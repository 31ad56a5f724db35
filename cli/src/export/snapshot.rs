//! What is exported of a frame.

use sorb::World;

use super::bodies::Bodies;

/// What is exported of a frame.
#[derive(Debug)]
pub(super) struct Snapshot {
    /// Positions of the particles \[m\].
    pub(super) particles: Vec<[f32; 3]>,
    /// Their velocities \[m/s\].
    pub(super) velocities: Vec<[f32; 3]>,
    /// Their pressures \[Pa\].
    pub(super) pressures: Vec<f32>,
    /// Their identities.
    pub(super) ids: Vec<u32>,
    /// Positions of the nodes \[m\].
    pub(super) nodes: Vec<[f32; 3]>,
    /// Their saturations, 0 without fluid.
    pub(super) saturations: Vec<f32>,
    /// Number of the sponge of every node.
    pub(super) sponges: Vec<u32>,
    /// Outer surface: nodes of every triangle.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Poses and surfaces of the bodies.
    pub(super) bodies: Bodies,
}

impl Snapshot {
    pub(super) fn of(world: &World) -> Self {
        let vectors = |rows: &[[f32; 4]]| rows.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
        let nodes: Vec<[f32; 3]> = vectors(world.node_positions());
        let mut saturations = world.node_saturations().to_vec();
        saturations.resize(nodes.len(), 0.0);
        Self {
            particles: vectors(world.particle_positions()),
            velocities: vectors(world.particle_velocities()),
            pressures: world.particle_pressures(),
            ids: world.particle_ids().to_vec(),
            nodes,
            saturations,
            sponges: world.lattice().node_sponge.clone(),
            triangles: world.lattice().triangles.clone(),
            bodies: Bodies::of(world),
        }
    }
}

/// Floats as little-endian bytes.
pub(super) fn floats<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u8> {
    values.into_iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Integers as little-endian bytes.
pub(super) fn integers<'a>(values: impl IntoIterator<Item = &'a u32>) -> Vec<u8> {
    values.into_iter().flat_map(|value| value.to_le_bytes()).collect()
}
