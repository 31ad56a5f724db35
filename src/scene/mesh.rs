//! Meshes of bodies, sponges and blocks of water.

use glam::Vec3;

use super::error::Problem;
use super::{BlockShape, Scene, ShapeKind};
use crate::mesh::{self, MeshError};

/// A closed surface of triangles, from a file or in the scene itself.
///
/// A scene that is read from a file takes `vertices` and `triangles` from the `file` of its mesh. It is complete then: saves and
/// recordings need no other file.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Mesh {
    /// File to read, relative to that of the scene: OBJ, STL or glTF (`.obj`, `.stl`, `.gltf`, `.glb`); default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Metres per unit of the vertices. Range 1e-6 to 1e6; default 1.
    pub scale: f32,
    /// Corners. Range -1000 to 1000 m; default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[cfg_attr(feature = "serde", schemars(with = "Vec<[f32; 3]>"))]
    pub vertices: Vec<Vec3>,
    /// Numbers of three corners, counter-clockwise seen from outside. Range 0 to 1e7; default none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<[u32; 3]>,
}

impl Default for Mesh {
    fn default() -> Self {
        Self { file: None, scale: 1.0, vertices: Vec::new(), triangles: Vec::new() }
    }
}

impl Mesh {
    /// The mesh in metres.
    ///
    /// # Errors
    /// It has a file that is not read yet, is empty or too large, has holes, or faces that do not all point outwards.
    pub fn solid(&self) -> Result<mesh::Mesh, MeshError> {
        if let Some(file) = &self.file {
            let message = format!("{file} is not read yet: Scene::read_meshes does that");
            return Err(MeshError::Read { message });
        }
        let vertices: Vec<Vec3> = self.vertices.iter().map(|vertex| *vertex * self.scale).collect();
        mesh::Mesh::new(&vertices, &self.triangles)
    }

    /// Largest distance of a corner from the origin \[m\].
    pub(super) fn reach(&self) -> f32 {
        self.scale * self.vertices.iter().map(|vertex| vertex.length()).fold(0.0, f32::max)
    }

    /// Adds what is wrong with it.
    pub(super) fn rules(&self, table: &str, problems: &mut Vec<Problem>) {
        if let Err(error) = self.solid() {
            let (key, value) = match &self.file {
                Some(file) => ("file", format!("{file:?}")),
                None => ("triangles", format!("({} triangles)", self.triangles.len())),
            };
            problems.push(Problem::rule(format!("{table}.{key}"), value, error.to_string()));
        }
    }
}

impl Scene {
    /// Reads the files of all meshes, which become `vertices` and `triangles`.
    ///
    /// # Errors
    /// The problems of all files: unreadable, of an unknown kind, empty, too large, with holes, or with faces that do not point outwards.
    pub fn read_meshes(&mut self, folder: &std::path::Path) -> Result<(), Vec<Problem>> {
        let mut problems = Vec::new();
        let mut read = |mesh: &mut Mesh, table: String| {
            let Some(file) = mesh.file.take() else { return };
            let found = mesh::Mesh::read(&folder.join(&file)).and_then(|found| {
                (mesh.vertices, mesh.triangles) = (found.vertices, found.triangles);
                mesh.solid().map(drop)
            });
            if let Err(error) = found {
                let key = format!("{table}.shape.mesh.file");
                problems.push(Problem::rule(key, format!("{file:?}"), error.to_string()));
            }
        };
        for (index, block) in self.fluid.iter_mut().flat_map(|fluid| &mut fluid.blocks).enumerate() {
            if let BlockShape::Mesh { mesh } = &mut block.shape {
                read(mesh, format!("fluid.blocks[{index}]"));
            }
        }
        for (index, sponge) in self.sponges.iter_mut().enumerate() {
            if let BlockShape::Mesh { mesh } = &mut sponge.shape {
                read(mesh, format!("sponges[{index}]"));
            }
        }
        for (index, body) in self.bodies.iter_mut().enumerate() {
            if let ShapeKind::Mesh { mesh, .. } = &mut body.shape {
                read(mesh, format!("bodies[{index}]"));
            }
        }
        if problems.is_empty() { Ok(()) } else { Err(problems) }
    }
}
