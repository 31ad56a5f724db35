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
fn vtp(path: &str) -> PolyDataPiece {
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

    let bytes = fs::read(format!("{folder}/scene_00004.glb")).expect("the file is there");
    // As it is built here, this reader takes attributes of one's own, such as `_SATURATION`, for invalid names.
    let file = gltf::Gltf::from_slice_without_validation(&bytes).expect("glTF");
    let blob = file.blob.as_deref();
    let meshes: Vec<_> = file.document.meshes().collect();
    let read = |mesh: usize| meshes[mesh].primitives().next().expect("a primitive");
    let places = |mesh: usize| -> Vec<f32> {
        let primitive = read(mesh);
        let reader = primitive.reader(|_| blob);
        reader.read_positions().expect("positions").flatten().collect()
    };
    assert_eq!((places(0), places(1)), (positions, nodes));
    let primitive = read(1);
    let indices = primitive.reader(|_| blob).read_indices().expect("indices").into_u32();
    assert_eq!(indices.collect::<Vec<_>>(), triangles);
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
