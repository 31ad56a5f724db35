//! Arrays of `NumPy`, version 1.0 of the format.

use super::snapshot::{Snapshot, floats, integers};

/// A file for every column.
pub(super) fn files(frame: &Snapshot) -> Vec<(String, Vec<u8>)> {
    fn vectors<const N: usize>(rows: &[[f32; N]]) -> Vec<u8> {
        file("<f4", &format!("({}, {N})", rows.len()), &floats(rows.as_flattened()))
    }
    let numbers = |rows: &[f32]| file("<f4", &format!("({},)", rows.len()), &floats(rows));
    let whole = |rows: &[u32]| file("<u4", &format!("({},)", rows.len()), &integers(rows));
    let triangles = &frame.triangles;
    let shape = format!("({}, 3)", triangles.len());
    let mut columns = vec![
        ("particle_positions", vectors(&frame.particles)),
        ("particle_velocities", vectors(&frame.velocities)),
        ("particle_pressures", numbers(&frame.pressures)),
        ("particle_ids", whole(&frame.ids)),
        ("node_positions", vectors(&frame.nodes)),
        ("node_saturations", numbers(&frame.saturations)),
        ("node_sponges", whole(&frame.sponges)),
        ("triangles", file("<u4", &shape, &integers(triangles.as_flattened()))),
    ];
    let bodies = &frame.bodies;
    if !bodies.is_empty() {
        columns.extend([
            ("body_numbers", whole(&bodies.numbers)),
            ("body_positions", vectors(&bodies.positions)),
            ("body_rotations", vectors(&bodies.rotations)),
            ("body_linear_velocities", vectors(&bodies.linear_velocities)),
            ("body_angular_velocities", vectors(&bodies.angular_velocities)),
        ]);
    }
    columns.into_iter().map(|(name, bytes)| (format!("{name}.npy"), bytes)).collect()
}

/// Header and values: the values begin at a multiple of 64 bytes.
fn file(kind: &str, shape: &str, values: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}");
    let padding = 63 - (10 + header.len()) % 64;
    let header = format!("{header}{}\n", " ".repeat(padding));
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    // At most two numbers of twenty digits: far below 65536.
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values);
    bytes
}
