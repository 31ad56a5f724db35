//! Bodies of a frame: their poses, and their surfaces as meshes.

use sorb::{
    World,
    glam::{Quat, Vec3},
    mesh::Mesh,
    rigid::{
        Body, Shape,
        rapier3d::parry::shape::{Ball, Capsule, Cuboid},
    },
};

/// Parts of a circle around a ball, and of half a circle from pole to pole.
const AROUND: u32 = 32;
const POLE_TO_POLE: u32 = 16;

/// The bodies that are there, in the order of the scene; one row a body.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    /// Numbers in the scene.
    pub(super) numbers: Vec<u32>,
    /// Names in the scene.
    pub(super) names: Vec<String>,
    /// Centres of mass \[m\].
    pub(super) positions: Vec<[f32; 3]>,
    /// Rotations from the frames of the bodies to the world: x, y, z, w.
    pub(super) rotations: Vec<[f32; 4]>,
    /// Velocities of the centres of mass \[m/s\].
    pub(super) linear_velocities: Vec<[f32; 3]>,
    /// Angular velocities \[rad/s\].
    pub(super) angular_velocities: Vec<[f32; 3]>,
    /// Surfaces in the frames of the bodies; empty for planes, which have no end.
    pub(super) meshes: Vec<Mesh>,
}

/// All surfaces as one, in the frame of the world.
#[derive(Debug, Default)]
pub(super) struct Surfaces {
    pub(super) vertices: Vec<[f32; 3]>,
    /// Number of the body of every vertex.
    pub(super) bodies: Vec<u32>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Bodies {
    pub(super) fn of(world: &World) -> Self {
        let mut found = Self::default();
        let bodies = world.bodies().iter().zip(&world.scene().bodies).enumerate();
        for (number, (body, own)) in bodies.filter(|(_, (_, own))| !own.is_removed()) {
            found.add(number as u32, &own.name, body);
        }
        found
    }

    fn add(&mut self, number: u32, name: &str, body: &Body) {
        self.numbers.push(number);
        self.names.push(name.to_owned());
        self.positions.push(body.state.position.to_array());
        self.rotations.push(body.state.rotation.to_array());
        self.linear_velocities.push(body.state.linear_velocity.to_array());
        self.angular_velocities.push(body.state.angular_velocity.to_array());
        self.meshes.push(mesh(&body.shape));
    }

    pub(super) fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    pub(super) fn surfaces(&self) -> Surfaces {
        let mut all = Surfaces::default();
        let poses = self.positions.iter().zip(&self.rotations);
        for ((number, mesh), (position, rotation)) in self.numbers.iter().zip(&self.meshes).zip(poses) {
            let (position, rotation) = (Vec3::from(*position), Quat::from_array(*rotation));
            let first = all.vertices.len() as u32;
            let in_world = |vertex: &Vec3| (position + rotation * *vertex).to_array();
            all.vertices.extend(mesh.vertices.iter().map(in_world));
            all.bodies.resize(all.vertices.len(), *number);
            all.triangles.extend(mesh.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
        }
        all
    }
}

/// The surface of a shape.
fn mesh(shape: &Shape) -> Mesh {
    let (vertices, triangles) = match shape {
        Shape::Plane => Default::default(),
        Shape::Sphere { radius } => Ball::new(*radius).to_trimesh(AROUND, POLE_TO_POLE),
        Shape::Cuboid { half_extents } => Cuboid::new(*half_extents).to_trimesh(),
        Shape::Capsule { half_height, radius } => {
            Capsule::new_y(*half_height, *radius).to_trimesh(AROUND, POLE_TO_POLE)
        }
        Shape::Hull { vertices, triangles, .. } => (vertices.clone(), triangles.clone()),
        Shape::Compound(compound) => (compound.vertices.clone(), compound.triangles.clone()),
    };
    Mesh { vertices, triangles }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    #[test]
    fn surfaces_are_closed_and_enclose_their_shapes() {
        let half_extents = Vec3::new(0.1, 0.2, 0.3);
        let shapes = [
            (Shape::Sphere { radius: 0.1 }, 4.0 / 3.0 * PI * 1e-3),
            (Shape::Cuboid { half_extents }, 8.0 * 6e-3),
            (Shape::Capsule { half_height: 0.2, radius: 0.1 }, (4.0 / 3.0 + 4.0) * PI * 1e-3),
        ];
        for (shape, volume) in shapes {
            let Mesh { vertices, triangles } = mesh(&shape);
            let checked = Mesh::new(&vertices, &triangles).unwrap();
            // Corners are on the surface: what is round is a little smaller.
            let ratio = checked.volume() / volume;
            assert!((0.97..1.0 + 1e-6).contains(&ratio), "{shape:?}: {ratio}");
            // The control: without one of its triangles it is open.
            assert!(Mesh::new(&vertices, &triangles[1..]).is_err());
        }
        assert!(mesh(&Shape::Plane).triangles.is_empty());
    }
}
