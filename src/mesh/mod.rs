//! Meshes of triangles, from which bodies and sponges are made.

#[cfg(feature = "mesh")]
mod read;

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};

/// Most triangles of a mesh: simplify finer ones first.
pub const MAX_TRIANGLES: usize = 100_000;

/// Why a mesh is of no use.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The file cannot be read.
    #[error("{message}")]
    Read {
        /// What the reader says.
        message: String,
    },
    /// The name of the file has another ending.
    #[error("unknown kind of file: the name must end in .obj, .stl, .gltf or .glb")]
    Kind,
    /// Files need a feature that this program is built without.
    #[error("files of meshes need the feature `mesh`")]
    NeedsMesh,
    /// A coordinate is not a number.
    #[error("vertex {index} = {value} is not finite")]
    NotFinite {
        /// Number of the vertex.
        index: usize,
        /// Its value.
        value: String,
    },
    /// There is no triangle.
    #[error("there are no triangles")]
    Empty,
    /// More triangles than [`MAX_TRIANGLES`].
    #[error("{found} triangles: at most {MAX_TRIANGLES}; simplify the mesh")]
    TooManyTriangles {
        /// Number of triangles.
        found: usize,
    },
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle} has the corner {corner}, and there are {vertices} vertices")]
    NoVertex {
        /// Number of the triangle.
        triangle: usize,
        /// The number of the vertex.
        corner: u32,
        /// How many there are.
        vertices: usize,
    },
    /// Edges with a triangle on one side only.
    #[error(
        "the surface has holes: {edges} edges belong to one triangle only, the first of them near {place}"
    )]
    Holes {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one.
        place: String,
    },
    /// Edges along which two triangles have opposite sides outside, or of more than two triangles.
    #[error(
        "neighbouring faces disagree about outside at {edges} edges, or more than two faces meet there, the first near {place}"
    )]
    Orientation {
        /// Number of such edges.
        edges: usize,
        /// Middle of the first one.
        place: String,
    },
    /// All faces are inverted.
    #[error("the faces point inwards: the enclosed volume is {volume} m^3")]
    InsideOut {
        /// Volume \[m^3\].
        volume: String,
    },
}

/// A closed surface of triangles with outward winding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners \[m\].
    pub vertices: Vec<Vec3>,
    /// Numbers of corners, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Mesh {
    /// A checked mesh. Corners at the same place become one, and triangles without area go.
    ///
    /// # Errors
    /// [`MeshError`], but for those of files.
    pub fn new(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        if let Some(index) = vertices.iter().position(|vertex| !vertex.is_finite()) {
            return Err(MeshError::NotFinite { index, value: vertices[index].to_string() });
        }
        if triangles.len() > MAX_TRIANGLES {
            return Err(MeshError::TooManyTriangles { found: triangles.len() });
        }
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(corner) = corners.iter().find(|corner| **corner as usize >= vertices.len()) {
                return Err(MeshError::NoVertex { triangle, corner: *corner, vertices: vertices.len() });
            }
        }
        let mesh = Self::welded(vertices, triangles);
        if mesh.triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        mesh.check_edges()?;
        let volume = mesh.volume();
        if volume > 0.0 { Ok(mesh) } else { Err(MeshError::InsideOut { volume: format!("{volume:.3e}") }) }
    }

    /// Reads a file of a mesh: OBJ, STL or glTF, by the ending of its name. It is not checked yet.
    ///
    /// # Errors
    /// [`MeshError::Read`], [`MeshError::Kind`], or [`MeshError::NeedsMesh`] without the feature `mesh`.
    pub fn read(path: &std::path::Path) -> Result<Self, MeshError> {
        #[cfg(feature = "mesh")]
        return read::read(path);
        #[cfg(not(feature = "mesh"))]
        {
            let _ = path;
            Err(MeshError::NeedsMesh)
        }
    }

    /// Lowest and highest coordinates \[m\].
    #[must_use]
    pub fn bounds(&self) -> (Vec3, Vec3) {
        let none = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        self.vertices.iter().fold(none, |(low, high), vertex| (low.min(*vertex), high.max(*vertex)))
    }

    /// The enclosed volume \[m^3\]; negative if the faces point inwards.
    #[must_use]
    pub fn volume(&self) -> f64 {
        let base = self.vertices.first().map_or(DVec3::ZERO, |vertex| vertex.as_dvec3());
        let corner = |index: u32| self.vertices[index as usize].as_dvec3() - base;
        let volumes =
            self.triangles.iter().map(|[a, b, c]| corner(*a).dot(corner(*b).cross(corner(*c))) / 6.0);
        volumes.sum()
    }

    /// One corner for each place, in the order of their first use.
    fn welded(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Self {
        let mut mesh = Self::default();
        let mut by_place = BTreeMap::new();
        for triangle in triangles {
            let corners = triangle.map(|index| {
                // Adding zero makes -0 and +0 the same place.
                let vertex = vertices[index as usize] + Vec3::ZERO;
                *by_place.entry(vertex.to_array().map(f32::to_bits)).or_insert_with(|| {
                    mesh.vertices.push(vertex);
                    mesh.vertices.len() as u32 - 1
                })
            });
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                mesh.triangles.push(corners);
            }
        }
        mesh
    }

    /// Every edge has to belong to two triangles, once in each direction.
    fn check_edges(&self) -> Result<(), MeshError> {
        let mut edges: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        for [a, b, c] in &self.triangles {
            for edge in [(*a, *b), (*b, *c), (*c, *a)] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        let place = |(from, to): (u32, u32)| {
            (0.5 * (self.vertices[from as usize] + self.vertices[to as usize])).to_string()
        };
        let twice: Vec<_> = edges.iter().filter(|(_, count)| **count > 1).map(|(edge, _)| *edge).collect();
        if let Some(first) = twice.first() {
            return Err(MeshError::Orientation { edges: twice.len(), place: place(*first) });
        }
        let open: Vec<_> = edges.keys().filter(|(from, to)| !edges.contains_key(&(*to, *from))).collect();
        match open.first() {
            Some(first) => Err(MeshError::Holes { edges: open.len(), place: place(**first) }),
            None => Ok(()),
        }
    }
}
