//! Binary PLY.

use super::snapshot::Snapshot;

/// Water as vertices, and sponges as vertices and faces.
pub(super) fn files(frame: &Snapshot) -> Vec<(String, Vec<u8>)> {
    let place = "property float x\nproperty float y\nproperty float z\n";
    let count = frame.particles.len();
    let mut water = header(&format!(
        "element vertex {count}\n{place}property float vx\nproperty float vy\nproperty float vz\n\
         property float pressure\nproperty uint id\n"
    ));
    let rows = frame.particles.iter().zip(&frame.velocities).zip(frame.pressures.iter().zip(&frame.ids));
    for ((position, velocity), (pressure, id)) in rows {
        for value in position.iter().chain(velocity).chain([pressure]) {
            water.extend(value.to_le_bytes());
        }
        water.extend(id.to_le_bytes());
    }
    let (nodes, faces) = (frame.nodes.len(), frame.triangles.len());
    let mut sponges = header(&format!(
        "element vertex {nodes}\n{place}property float saturation\nproperty uint sponge\n\
         element face {faces}\nproperty list uchar uint vertex_indices\n"
    ));
    for ((position, saturation), sponge) in frame.nodes.iter().zip(&frame.saturations).zip(&frame.sponges) {
        for value in position.iter().chain([saturation]) {
            sponges.extend(value.to_le_bytes());
        }
        sponges.extend(sponge.to_le_bytes());
    }
    for triangle in &frame.triangles {
        sponges.push(3);
        sponges.extend(triangle.iter().flat_map(|node| node.to_le_bytes()));
    }
    vec![("water.ply".to_owned(), water), ("sponges.ply".to_owned(), sponges)]
}

fn header(elements: &str) -> Vec<u8> {
    format!("ply\nformat binary_little_endian 1.0\ncomment sorb, SI units, Y up\n{elements}end_header\n")
        .into_bytes()
}
