//! VTK poly data as XML with numbers as text, and series of them.

use std::fmt::{Display, Write as _};

use super::{bodies::Surfaces, snapshot::Snapshot};

/// Water as vertices, sponges and bodies as triangles.
pub(super) fn files(frame: &Snapshot) -> Vec<(String, Vec<u8>)> {
    let count = frame.particles.len();
    let mut water = begin(count, count, 0);
    water.push_str("<PointData>\n");
    vectors(&mut water, "velocity", &frame.velocities);
    numbers(&mut water, ("Float32", "pressure"), &frame.pressures);
    numbers(&mut water, ("UInt32", "id"), &frame.ids);
    water.push_str("</PointData>\n<Points>\n");
    vectors(&mut water, "position", &frame.particles);
    water.push_str("</Points>\n<Verts>\n");
    cells(&mut water, &(0..count as u32).collect::<Vec<_>>(), 1);
    water.push_str("</Verts>\n");
    end(&mut water);

    let sponges = mesh(&frame.nodes, &frame.triangles, |text| {
        numbers(text, ("Float32", "saturation"), &frame.saturations);
        numbers(text, ("UInt32", "sponge"), &frame.sponges);
    });
    let mut files =
        vec![("water.vtp".to_owned(), water.into_bytes()), ("sponges.vtp".to_owned(), sponges.into_bytes())];
    if !frame.bodies.is_empty() {
        let Surfaces { vertices, bodies, triangles } = frame.bodies.surfaces();
        let bodies = mesh(&vertices, &triangles, |text| numbers(text, ("UInt32", "body"), &bodies));
        files.push(("bodies.vtp".to_owned(), bodies.into_bytes()));
    }
    files
}

/// Triangles, with data of their corners.
pub(super) fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]], data: impl FnOnce(&mut String)) -> String {
    let mut text = begin(positions.len(), 0, triangles.len());
    text.push_str("<PointData>\n");
    data(&mut text);
    text.push_str("</PointData>\n<Points>\n");
    vectors(&mut text, "position", positions);
    text.push_str("</Points>\n<Polys>\n");
    cells(&mut text, triangles.as_flattened(), 3);
    text.push_str("</Polys>\n");
    end(&mut text);
    text
}

/// A series: files with their times \[s\].
pub(super) fn series<'a>(files: impl Iterator<Item = (f64, &'a str)>) -> String {
    let mut text =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n".to_owned();
    for (time, file) in files {
        let _ = writeln!(text, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{file}\"/>");
    }
    text + "</Collection>\n</VTKFile>\n"
}

fn begin(points: usize, vertices: usize, triangles: usize) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{vertices}\" \
         NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"{triangles}\">\n"
    )
}

fn end(text: &mut String) {
    text.push_str("</Piece>\n</PolyData>\n</VTKFile>\n");
}

fn vectors(text: &mut String, name: &str, rows: &[[f32; 3]]) {
    array(text, ("Float32", name, 3), rows.as_flattened());
}

fn numbers<T: Display>(text: &mut String, (kind, name): (&str, &str), rows: &[T]) {
    array(text, (kind, name, 1), rows);
}

/// Cells of as many points each, one after the other.
fn cells(text: &mut String, points: &[u32], each: usize) {
    array(text, ("Int64", "connectivity", 1), points);
    let ends: Vec<usize> = (1..=points.len() / each).map(|cell| cell * each).collect();
    array(text, ("Int64", "offsets", 1), &ends);
}

/// Shortest digits that give the same number back.
fn array<T: Display>(text: &mut String, (kind, name, components): (&str, &str, u32), values: &[T]) {
    let _ = write!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for value in values {
        let _ = write!(text, "{value} ");
    }
    text.push_str("</DataArray>\n");
}
