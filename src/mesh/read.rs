//! Files of meshes.

use std::{fs, path::Path};

use glam::Vec3;

use super::{MAX_TRIANGLES, Mesh, MeshError};

/// Reads OBJ, STL or glTF, by the ending of the name.
pub(super) fn read(path: &Path) -> Result<Mesh, MeshError> {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    match ending.to_str() {
        Some("obj") => obj(path),
        Some("stl") => stl(path),
        Some("gltf" | "glb") => gltf(path),
        _ => Err(MeshError::Kind),
    }
}

fn failed(error: impl std::fmt::Display) -> MeshError {
    MeshError::Read { message: error.to_string() }
}

fn check_count(found: usize) -> Result<(), MeshError> {
    if found > MAX_TRIANGLES { Err(MeshError::TooManyTriangles { found }) } else { Ok(()) }
}

/// All objects of the file as one mesh.
fn obj(path: &Path) -> Result<Mesh, MeshError> {
    let text = fs::read(path).map_err(failed)?;
    let options = tobj::LoadOptions { triangulate: true, ..tobj::LoadOptions::default() };
    // Materials have no use here.
    let without_materials = |_: &Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut &text[..], &options, without_materials).map_err(failed)?;
    check_count(models.iter().map(|model| model.mesh.indices.len() / 3).sum())?;
    let mut mesh = Mesh::default();
    for model in &models {
        let first = mesh.vertices.len() as u32;
        let (places, _) = model.mesh.positions.as_chunks::<3>();
        mesh.vertices.extend(places.iter().map(|place| Vec3::from_array(*place)));
        let (triangles, _) = model.mesh.indices.as_chunks::<3>();
        mesh.triangles.extend(triangles.iter().map(|triangle| triangle.map(|index| first + index)));
    }
    Ok(mesh)
}

fn stl(path: &Path) -> Result<Mesh, MeshError> {
    let bytes = fs::read(path).map_err(failed)?;
    let found = stl_io::read_stl(&mut std::io::Cursor::new(bytes)).map_err(failed)?;
    check_count(found.faces.len())?;
    let vertices = found.vertices.iter().map(|vertex| Vec3::new(vertex[0], vertex[1], vertex[2]));
    let triangles = found.faces.iter().map(|face| face.vertices.map(|index| index as u32));
    Ok(Mesh { vertices: vertices.collect(), triangles: triangles.collect() })
}

/// All meshes of the default scene, with the transforms of their nodes.
fn gltf(path: &Path) -> Result<Mesh, MeshError> {
    let gltf::Gltf { document, blob } = gltf::Gltf::open(path).map_err(failed)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let buffers: Vec<Vec<u8>> = document
        .buffers()
        .map(|buffer| match buffer.source() {
            gltf::buffer::Source::Bin => blob.clone().ok_or_else(|| failed("the binary chunk is missing")),
            gltf::buffer::Source::Uri(uri) if uri.starts_with("data:") => {
                Err(failed("data within the text is not read: save it as .glb"))
            }
            gltf::buffer::Source::Uri(uri) => {
                fs::read(folder.join(uri)).map_err(|error| failed(format_args!("{uri}: {error}")))
            }
        })
        .collect::<Result<_, _>>()?;
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err(MeshError::Empty);
    };
    let mut mesh = Mesh::default();
    let mut nodes: Vec<_> = scene.nodes().map(|node| (node, glam::Mat4::IDENTITY)).collect();
    let mut visited = 0;
    while let Some((node, parent)) = nodes.pop() {
        visited += 1;
        if visited > document.nodes().len() {
            return Err(failed("a node has two parents: the nodes of a scene must form trees"));
        }
        let place = parent * glam::Mat4::from_cols_array_2d(&node.transform().matrix());
        nodes.extend(node.children().map(|child| (child, place)));
        for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
            if primitive.mode() != gltf::mesh::Mode::Triangles {
                return Err(failed("only triangles are read: other primitives are in the file"));
            }
            let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(Vec::as_slice));
            let Some(places) = reader.read_positions() else { continue };
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(places.map(|at| place.transform_point3(Vec3::from_array(at))));
            let count = mesh.vertices.len() as u32 - first;
            let indices: Vec<u32> =
                reader.read_indices().map_or_else(|| (0..count).collect(), |all| all.into_u32().collect());
            check_count(mesh.triangles.len() + indices.len() / 3)?;
            let (triangles, _) = indices.as_chunks::<3>();
            let is_mirrored = place.determinant() < 0.0;
            mesh.triangles.extend(triangles.iter().map(|triangle| {
                let [a, b, c] = triangle.map(|index| first.saturating_add(index));
                if is_mirrored { [a, c, b] } else { [a, b, c] }
            }));
        }
    }
    Ok(mesh)
}
