//! Binary PLY.

use super::{bodies::Surfaces, snapshot::Snapshot};

const PLACE: &str = "property float x\nproperty float y\nproperty float z\n";

/// Water as vertices, sponges and bodies as vertices and faces.
pub(super) fn files(frame: &Snapshot) -> Vec<(String, Vec<u8>)> {
    let count = frame.particles.len();
    let mut water = header(&format!(
        "element vertex {count}\n{PLACE}property float vx\nproperty float vy\nproperty float vz\n\
         property float pressure\nproperty uint id\n"
    ));
    let rows = frame.particles.iter().zip(&frame.velocities).zip(frame.pressures.iter().zip(&frame.ids));
    for ((position, velocity), (pressure, id)) in rows {
        for value in position.iter().chain(velocity).chain([pressure]) {
            water.extend(value.to_le_bytes());
        }
        water.extend(id.to_le_bytes());
    }
    let (nodes, faces) = (frame.nodes.len(), elements(frame.triangles.len()));
    let mut sponges = header(&format!(
        "element vertex {nodes}\n{PLACE}property float saturation\nproperty uint sponge\n{faces}"
    ));
    for ((position, saturation), sponge) in frame.nodes.iter().zip(&frame.saturations).zip(&frame.sponges) {
        for value in position.iter().chain([saturation]) {
            sponges.extend(value.to_le_bytes());
        }
        sponges.extend(sponge.to_le_bytes());
    }
    triangles(&mut sponges, &frame.triangles);
    let mut files = vec![("water.ply".to_owned(), water), ("sponges.ply".to_owned(), sponges)];
    if !frame.bodies.is_empty() {
        files.push(("bodies.ply".to_owned(), bodies(&frame.bodies.surfaces())));
    }
    files
}

fn bodies(surfaces: &Surfaces) -> Vec<u8> {
    let (count, faces) = (surfaces.vertices.len(), elements(surfaces.triangles.len()));
    let mut bytes = header(&format!("element vertex {count}\n{PLACE}property uint body\n{faces}"));
    for (position, body) in surfaces.vertices.iter().zip(&surfaces.bodies) {
        bytes.extend(position.iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(body.to_le_bytes());
    }
    triangles(&mut bytes, &surfaces.triangles);
    bytes
}

/// A mesh without more.
#[cfg(feature = "surface")]
pub(super) fn mesh(vertices: &[[f32; 3]], corners: &[[u32; 3]]) -> Vec<u8> {
    let (count, faces) = (vertices.len(), elements(corners.len()));
    let mut bytes = header(&format!("element vertex {count}\n{PLACE}{faces}"));
    bytes.extend(vertices.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
    triangles(&mut bytes, corners);
    bytes
}

/// So many triangles, in a header.
fn elements(faces: usize) -> String {
    format!("element face {faces}\nproperty list uchar uint vertex_indices\n")
}

fn triangles(bytes: &mut Vec<u8>, triangles: &[[u32; 3]]) {
    for triangle in triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|corner| corner.to_le_bytes()));
    }
}

fn header(elements: &str) -> Vec<u8> {
    format!("ply\nformat binary_little_endian 1.0\ncomment sorb, SI units, Y up\n{elements}end_header\n")
        .into_bytes()
}
