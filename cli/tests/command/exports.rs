//! `sorb run --export`: what is written is read back by readers of each format.

use std::{collections::BTreeSet, fs, path::Path};

use ply_rs_bw::{
    parser::Parser,
    ply::{DefaultElement, Property},
};
use vtkio::{
    Vtk,
    model::{Attribute, DataSet, Piece, PolyDataPiece},
};

use crate::support::{Scratch, sorb};

/// A column of an exported frame.
fn npy<T: npyz::Deserialize>(folder: &str, name: &str) -> (Vec<u64>, Vec<T>) {
    let bytes = fs::read(format!("{folder}/{name}.npy")).expect("the file is there");
    let file = npyz::NpyFile::new(&bytes[..]).expect("an array");
    (file.shape().to_vec(), file.into_vec().expect("values of its type"))
}

/// The poly data of a file.
pub(crate) fn vtp(path: &str) -> PolyDataPiece {
    let DataSet::PolyData { mut pieces, .. } = Vtk::import(path).expect("VTK").data else {
        panic!("{path} is no poly data");
    };
    let Some(Piece::Inline(piece)) = pieces.pop() else { panic!("{path} has no piece") };
    *piece
}

/// Values of an attribute of points.
fn attribute(piece: &PolyDataPiece, name: &str) -> Vec<f32> {
    let own = piece.data.point.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == name => array.data.cast_into::<f32>(),
        _ => None,
    });
    own.expect("the attribute is there")
}

/// Rows of numbers of the vertices of a PLY file, and its number of faces.
fn ply(path: &str, names: &[&str]) -> (Vec<f32>, usize) {
    let bytes = fs::read(path).expect("the file is there");
    let file = Parser::<DefaultElement>::new().read_ply(&mut &bytes[..]).expect("PLY");
    let value = |vertex: &DefaultElement, name: &str| match &vertex[name] {
        Property::Float(value) => *value,
        Property::UInt(value) => *value as f32,
        other => panic!("{name}: {other:?}"),
    };
    let rows =
        file.payload["vertex"].iter().flat_map(|vertex| names.iter().map(move |name| value(vertex, name)));
    (rows.collect(), file.payload.get("face").map_or(0, Vec::len))
}

/// Corners and triangles of a PLY file.
#[cfg(feature = "surface")]
pub(crate) fn ply_mesh(path: &str) -> (Vec<f32>, Vec<[u32; 3]>) {
    let bytes = fs::read(path).expect("the file is there");
    let file = Parser::<DefaultElement>::new().read_ply(&mut &bytes[..]).expect("PLY");
    let triangle = |face: &DefaultElement| match &face["vertex_indices"] {
        Property::ListUInt(corners) => <[u32; 3]>::try_from(corners.as_slice()).expect("three corners"),
        other => panic!("{other:?}"),
    };
    let triangles = file.payload.get("face").into_iter().flatten().map(triangle).collect();
    (ply(path, &["x", "y", "z"]).0, triangles)
}

/// A binary glTF file, after its reader has found it valid.
fn glb(path: &str) -> (gltf::Document, Vec<u8>) {
    let file = gltf::Gltf::from_slice(&fs::read(path).expect("the file is there")).expect("glTF");
    (file.document, file.blob.unwrap_or_default())
}

/// Positions of a mesh of one primitive.
fn places(mesh: &gltf::Mesh<'_>, blob: &[u8]) -> Vec<f32> {
    let primitive = mesh.primitives().next().expect("a primitive");
    primitive.reader(|_| Some(blob)).read_positions().expect("positions").flatten().collect()
}

fn indices(mesh: &gltf::Mesh<'_>, blob: &[u8]) -> Vec<u32> {
    let primitive = mesh.primitives().next().expect("a primitive");
    primitive.reader(|_| Some(blob)).read_indices().expect("indices").into_u32().collect()
}

#[test]
fn all_formats_are_read_back_with_the_same_numbers() {
    let scratch = Scratch::new("exports");
    let out = scratch.path("out");
    let run = ["run", "ball_drop", "--resolution", "0.3", "--frames", "4", "--quiet", "--out", &out];
    let answer = sorb(&[&run[..], &["--export", "vtp,ply,npy,gltf", "--export-every", "2"]].concat());
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    let folder = scratch.path("out/export");
    let (shape, positions) = npy::<f32>(&folder, "particle_positions_00004");
    let (_, velocities) = npy::<f32>(&folder, "particle_velocities_00004");
    let (_, pressures) = npy::<f32>(&folder, "particle_pressures_00004");
    let (_, ids) = npy::<u32>(&folder, "particle_ids_00004");
    let (_, nodes) = npy::<f32>(&folder, "node_positions_00004");
    let (_, saturations) = npy::<f32>(&folder, "node_saturations_00004");
    let (faces, triangles) = npy::<u32>(&folder, "triangles_00004");
    assert_eq!(shape, [positions.len() as u64 / 3, 3]);
    assert!(positions.len() > 300 && pressures.iter().any(|pressure| *pressure > 0.0));
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());

    let water = vtp(&format!("{folder}/water_00004.vtp"));
    assert_eq!(water.points.clone().cast_into::<f32>().as_ref(), Some(&positions));
    assert_eq!(
        (attribute(&water, "velocity"), attribute(&water, "pressure")),
        (velocities.clone(), pressures.clone())
    );
    let sponges = vtp(&format!("{folder}/sponges_00004.vtp"));
    assert_eq!(sponges.points.clone().cast_into::<f32>().as_ref(), Some(&nodes));
    assert_eq!(attribute(&sponges, "saturation"), saturations);
    assert_eq!(sponges.polys.expect("triangles").num_cells() as u64, faces[0]);

    let (points, none) = ply(&format!("{folder}/water_00004.ply"), &["x", "y", "z"]);
    assert_eq!((points, none), (positions.clone(), 0));
    assert_eq!(ply(&format!("{folder}/water_00004.ply"), &["vx", "vy", "vz"]).0, velocities);
    assert_eq!(
        ply(&format!("{folder}/sponges_00004.ply"), &["x", "y", "z"]),
        (nodes.clone(), faces[0] as usize)
    );
    assert_eq!(ply(&format!("{folder}/sponges_00004.ply"), &["saturation"]).0, saturations);

    let (document, blob) = glb(&format!("{folder}/scene_00004.glb"));
    let meshes: Vec<_> = document.meshes().collect();
    assert_eq!((places(&meshes[0], &blob), places(&meshes[1], &blob)), (positions, nodes));
    assert_eq!(indices(&meshes[1], &blob), triangles);
}

/// A ball that falls, a turned box, a cup and a floor without an end.
const BODIES: &str = r#"
version = 1
name = "bodies"
[[bodies]]
name = "ball"
shape = { kind = "sphere", radius = 0.02 }
position = [0.1, 0.2, 0.0]
[[bodies]]
name = "box"
kind = "fixed"
shape = { kind = "cuboid", half_extents = [0.01, 0.02, 0.03] }
position = [-0.1, 0.1, 0.0]
rotation = { axis = [0.0, 0.0, 1.0], degrees = 30.0 }
[[bodies]]
name = "floor"
kind = "fixed"
shape = { kind = "plane" }
[[bodies]]
name = "cup"
kind = "fixed"
shape = { kind = "cup", radius = 0.03, height = 0.05, thickness = 0.005 }
position = [0.0, 0.0, 0.2]
"#;

#[test]
fn bodies_are_meshes_at_their_poses() {
    let scratch = Scratch::new("exported_bodies");
    let (scene, out) = (scratch.write("bodies.toml", BODIES), scratch.path("out"));
    let run = ["run", &scene, "--frames", "3", "--quiet", "--out", &out, "--export", "vtp,ply,npy,gltf"];
    let answer = sorb(&run);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    let folder = scratch.path("out/export");

    // The poses are those of the table.
    let (_, numbers) = npy::<u32>(&folder, "body_numbers_00003");
    let (shape, positions) = npy::<f32>(&folder, "body_positions_00003");
    let (_, rotations) = npy::<f32>(&folder, "body_rotations_00003");
    let (_, velocities) = npy::<f32>(&folder, "body_linear_velocities_00003");
    assert_eq!((numbers.as_slice(), shape.as_slice()), (&[0, 1, 2, 3][..], &[4, 3][..]));
    let table = scratch.read("out/bodies.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let rows: Vec<_> = rows.iter().filter(|row| row[0] == "3").collect();
    assert_eq!(rows.iter().map(|row| row[2]).collect::<Vec<_>>(), ["ball", "box", "floor", "cup"]);
    let columns = |from: usize, to: usize| -> Vec<f32> {
        rows.iter()
            .flat_map(|row| row[from..to].iter().map(|value| value.parse().expect("a number")))
            .collect()
    };
    assert_eq!((positions.clone(), rotations, velocities), (columns(3, 6), columns(6, 10), columns(10, 13)));
    assert!(positions[1] < 0.2, "the ball falls");

    // Corners of the ball are on the ball, in its present place and in no other.
    let piece = vtp(&format!("{folder}/bodies_00003.vtp"));
    let corners = piece.points.clone().cast_into::<f32>().expect("positions");
    let bodies = attribute(&piece, "body");
    let of_body = |body: f32| -> Vec<[f32; 3]> {
        let rows = corners.as_chunks::<3>().0.iter().zip(&bodies);
        rows.filter(|(_, own)| **own == body).map(|(row, _)| *row).collect()
    };
    let farthest = |centre: [f32; 3]| {
        let distance =
            |row: &[f32; 3]| row.iter().zip(&centre).map(|(a, b)| (a - b) * (a - b)).sum::<f32>().sqrt();
        of_body(0.0).iter().map(|row| (distance(row) - 0.02).abs()).fold(0.0, f32::max)
    };
    assert!(farthest([positions[0], positions[1], positions[2]]) < 1e-6);
    assert!(farthest([0.1, 0.2, 0.0]) > 1e-3, "the control: where it was at first");
    // The highest corner of the turned box.
    let highest = of_body(1.0).iter().map(|row| row[1]).fold(f32::MIN, f32::max);
    assert!((highest - (0.1 + 0.02 * 0.866_025_4 + 0.01 * 0.5)).abs() < 1e-6, "{highest}");
    assert!(of_body(2.0).is_empty() && of_body(3.0).len() > 24, "a plane has no end, a cup has a mesh");

    // The other formats have the same.
    let faces = piece.polys.expect("triangles").num_cells() as usize;
    assert_eq!(ply(&format!("{folder}/bodies_00003.ply"), &["x", "y", "z"]), (corners.clone(), faces));
    assert_eq!(ply(&format!("{folder}/bodies_00003.ply"), &["body"]).0, bodies);
    let (document, blob) = glb(&format!("{folder}/scene_00003.glb"));
    assert_eq!(
        document.nodes().filter_map(|node| node.name()).collect::<Vec<_>>(),
        ["ball", "box", "floor", "cup"]
    );
    let in_world = document.nodes().flat_map(|node| {
        let matrix = node.transform().matrix();
        let own = node.mesh().map(|mesh| places(&mesh, &blob)).unwrap_or_default();
        let at = move |row: &[f32; 3]| {
            [0, 1, 2]
                .map(|axis| (0..3).map(|from| matrix[from][axis] * row[from]).sum::<f32>() + matrix[3][axis])
        };
        own.as_chunks::<3>().0.iter().flat_map(at).collect::<Vec<_>>()
    });
    let in_world: Vec<f32> = in_world.collect();
    assert_eq!(in_world.len(), corners.len());
    assert!(in_world.iter().zip(&corners).all(|(one, other)| (one - other).abs() < 1e-6));
    assert!(scratch.read("out/export/bodies.pvd").contains("file=\"bodies_00003.vtp\""));
}

/// Chunks of a binary glTF file: its description, and the place of the buffer in the file.
fn chunks(bytes: &[u8]) -> (serde_json::Value, usize) {
    let length = u32::from_le_bytes(bytes[12..16].try_into().expect("four bytes")) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).expect("JSON"), 20 + length + 8)
}

/// What is wrong with views and bounds, which the reader does not look at.
fn wrong_numbers(bytes: &[u8]) -> Vec<String> {
    let (description, start) = chunks(bytes);
    let whole = |value: &serde_json::Value| value.as_u64().expect("a whole number") as usize;
    let (buffer, mut wrong) = (&bytes[start..], Vec::new());
    if whole(&description["buffers"][0]["byteLength"]) != buffer.len() || !start.is_multiple_of(4) {
        wrong.push("the buffer".to_owned());
    }
    let views = description["bufferViews"].as_array().expect("views");
    for view in views {
        let [from, length] = [&view["byteOffset"], &view["byteLength"]].map(whole);
        if !from.is_multiple_of(4) || from + length > buffer.len() {
            wrong.push(format!("view at {from}"));
        }
    }
    for accessor in description["accessors"].as_array().expect("accessors") {
        let view = &views[whole(&accessor["bufferView"])];
        let (from, width) = (whole(&view["byteOffset"]), if accessor["type"] == "VEC3" { 3 } else { 1 });
        let count = width * whole(&accessor["count"]);
        if 4 * count != whole(&view["byteLength"]) {
            wrong.push(format!("accessor at {from}"));
            continue;
        }
        let bounds = accessor
            .get("min")
            .and_then(|_| Some((accessor["min"].as_array()?, accessor["max"].as_array()?)));
        let words = buffer[from..from + 4 * count].as_chunks::<4>().0.iter();
        let values: Vec<f32> = words.map(|word| f32::from_le_bytes(*word)).collect();
        for (axis, (low, high)) in bounds.into_iter().flat_map(|(low, high)| low.iter().zip(high)).enumerate()
        {
            let own = || values.iter().skip(axis).step_by(width).copied();
            let (least, most) = (own().fold(f32::MAX, f32::min), own().fold(f32::MIN, f32::max));
            let is = |bound: &serde_json::Value, value: f32| {
                bound.as_f64().map(|bound| bound as f32) == Some(value)
            };
            if !is(low, least) || !is(high, most) {
                wrong.push(format!("bounds of axis {axis} at {from}"));
            }
        }
    }
    wrong
}

#[test]
fn gltf_files_are_valid_and_faults_are_found() {
    let scratch = Scratch::new("valid_gltf");
    let out = scratch.path("out");
    let run = ["run", "ball_drop", "--resolution", "0.3", "--frames", "1", "--quiet", "--out", &out];
    assert_eq!(sorb(&[&run[..], &["--export", "gltf"]].concat()).code, Some(0));
    let bytes = fs::read(scratch.path("out/export/scene_00001.glb")).expect("the file is there");
    assert!(gltf::Gltf::from_slice(&bytes).is_ok());
    assert_eq!(wrong_numbers(&bytes), Vec::<String>::new());

    // The controls: a node of a mesh that is not there, and a coordinate out of the bounds.
    let at = bytes.windows(8).position(|text| text == b"\"mesh\":0").expect("a node with a mesh");
    let mut planted = bytes.clone();
    planted[at + 7] = b'9';
    assert!(gltf::Gltf::from_slice(&planted).is_err());
    let start = chunks(&bytes).1;
    let mut planted = bytes;
    planted[start..start + 4].copy_from_slice(&1e9_f32.to_le_bytes());
    assert_eq!(wrong_numbers(&planted), ["bounds of axis 0 at 0"]);
}

#[test]
fn a_series_has_the_times_of_its_frames_and_a_new_run_replaces_it() {
    let scratch = Scratch::new("series");
    let out = scratch.path("out");
    let run = |frames: &str, more: &[&str]| {
        let run = ["run", "ball_drop", "--resolution", "0.3", "--frames", frames, "--quiet", "--out", &out];
        let answer = sorb(&[&run[..], more].concat());
        assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    };
    run("6", &["--export", "vtp", "--export-every", "3"]);
    let series = scratch.read("out/export/water.pvd");
    let lines: Vec<&str> = series.lines().filter(|line| line.starts_with("<DataSet")).collect();
    assert_eq!(
        lines,
        [
            "<DataSet timestep=\"0.0\" part=\"0\" file=\"water_00000.vtp\"/>",
            "<DataSet timestep=\"0.05\" part=\"0\" file=\"water_00003.vtp\"/>",
            "<DataSet timestep=\"0.1\" part=\"0\" file=\"water_00006.vtp\"/>",
        ]
    );
    run("3", &["--export", "vtp", "--export-every", "3"]);
    assert!(!Path::new(&scratch.path("out/export/water_00006.vtp")).exists());
    assert!(!scratch.read("out/export/water.pvd").contains("00006"));
}

#[test]
fn unknown_formats_are_wrong_usage() {
    for wrong in
        [&["--export", "abc"][..], &["--export", "vtp", "--export-every", "0"], &["--export-every", "2"]]
    {
        assert_eq!(sorb(&[&["run", "dry"], wrong].concat()).code, Some(2), "{wrong:?}");
    }
}
