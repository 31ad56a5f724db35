//! `sorb run --export surface`: meshes of the water.

use sorb::{glam::Vec3, mesh::Mesh};

use crate::{
    exports::{ply_mesh, vtp},
    support::{Scratch, sorb},
};

/// A block of water in the middle of a box.
const BLOCK: &str = r#"
version = 1
name = "block"
domain = { kind = "box", minimum = [-0.2, 0.0, -0.2], maximum = [0.2, 0.4, 0.2] }
[fluid]
spacing = 0.01
blocks = [{ minimum = [-0.1, 0.1, -0.08], maximum = [0.1, 0.25, 0.08] }]
"#;

const VOLUME: f64 = 0.2 * 0.15 * 0.16;

#[test]
fn a_block_of_water_is_a_closed_mesh_of_its_volume() {
    let scratch = Scratch::new("surface");
    let (scene, out) = (scratch.write("block.toml", BLOCK), scratch.path("out"));
    let run = ["run", &scene, "--frames", "1", "--quiet", "--out", &out, "--export", "surface,vtp"];
    let answer = sorb(&run);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    let (corners, triangles) = ply_mesh(&scratch.path("out/export/surface_00000.ply"));
    let vertices: Vec<Vec3> = corners.as_chunks::<3>().0.iter().copied().map(Vec3::from).collect();
    let mesh = Mesh::new(&vertices, &triangles).expect("closed, and outside is outside");
    let ratio = mesh.volume() / VOLUME;
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
    let (low, high) = mesh.bounds();
    let error = (low - Vec3::new(-0.1, 0.1, -0.08)).abs().max((high - Vec3::new(0.1, 0.25, 0.08)).abs());
    assert!(error.max_element() < 0.005, "within half a spacing of the block: {low} to {high}");
    // The controls: an open mesh, and one of particles of another size.
    assert!(Mesh::new(&vertices, &triangles[1..]).is_err());
    let scaled: Vec<Vec3> = vertices.iter().map(|vertex| *vertex * 1.01).collect();
    assert!((Mesh::new(&scaled, &triangles).expect("closed").volume() / VOLUME - 1.0).abs() > 0.02);

    // As VTK it is the same, and has a series.
    let piece = vtp(&scratch.path("out/export/surface_00000.vtp"));
    assert_eq!(piece.points.clone().cast_into::<f32>(), Some(corners));
    assert!(scratch.read("out/export/surface.pvd").contains("surface_00001.vtp"));
}

#[test]
fn a_mesh_of_the_water_changes_no_digest_and_may_be_empty() {
    let scratch = Scratch::new("surface_digest");
    let digest = |more: &[&str]| {
        let out = scratch.path("out");
        let run = ["run", "ball_drop", "--resolution", "0.3", "--frames", "2", "--json", "--out", &out];
        sorb(&[&run[..], more].concat()).json()["digest"].to_string()
    };
    assert_eq!(digest(&["--export", "surface"]), digest(&[]));
    let out = scratch.path("dry");
    let answer = sorb(&["run", "dry", "--frames", "0", "--quiet", "--out", &out, "--export", "surface"]);
    assert_eq!((answer.code, answer.err.as_str()), (Some(0), ""));
    assert_eq!(ply_mesh(&scratch.path("dry/export/surface_00000.ply")), (Vec::new(), Vec::new()));
}
