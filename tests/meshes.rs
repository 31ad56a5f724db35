//! Bodies, sponges and blocks of water from meshes.

mod common;

use std::{fs, path::PathBuf};

use sorb::{
    Command, Region, World,
    glam::{Quat, UVec3, Vec3},
    scene::{Axis, BlockShape, Fluid, FluidBlock, Mesh, Scene, ShapeKind, Sponge},
};

/// A folder of its own for a test.
fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("meshes_{name}"));
    fs::create_dir_all(&path).unwrap_or_else(|error| panic!("{error}"));
    path
}

/// A wedge: corners and outward triangles, in centimetres.
const CORNERS: [[f32; 3]; 6] =
    [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 5.0], [4.0, 0.0, 5.0], [0.0, 3.0, 5.0]];
const FACES: [[u32; 3]; 8] =
    [[0, 2, 1], [3, 4, 5], [0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]];
const VOLUME: f64 = 30e-6;

fn obj(faces: &[[u32; 3]]) -> String {
    let corners = CORNERS.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let faces = faces.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    corners.chain(faces).collect()
}

fn stl() -> String {
    let corner = |index: u32| {
        let [x, y, z] = CORNERS[index as usize];
        format!("vertex {x} {y} {z}\n")
    };
    let facet = |[a, b, c]: &[u32; 3]| {
        let loops = [corner(*a), corner(*b), corner(*c)].concat();
        format!("facet normal 0 0 0\nouter loop\n{loops}endloop\nendfacet\n")
    };
    format!("solid wedge\n{}endsolid wedge\n", FACES.iter().map(facet).collect::<String>())
}

/// Binary glTF, with a node that mirrors and moves.
fn glb() -> Vec<u8> {
    let mut data: Vec<u8> = CORNERS.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
    let places = data.len();
    data.extend(FACES.iter().flatten().flat_map(|index| (*index as u16).to_le_bytes()));
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
        "nodes":[{{"mesh":0,"scale":[-1,1,1],"translation":[1,2,3]}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[0,0,0],"max":[4,3,5]}},
        {{"bufferView":1,"componentType":5123,"count":24,"type":"SCALAR"}}],
        "bufferViews":[{{"buffer":0,"byteLength":{places}}},{{"buffer":0,"byteOffset":{places},"byteLength":48}}],
        "buffers":[{{"byteLength":{}}}]}}"#,
        data.len()
    );
    let mut json = json.into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let chunk =
        |kind: &[u8; 4], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes()[..], kind, bytes].concat();
    let chunks = [chunk(b"JSON", &json), chunk(b"BIN\0", &data)].concat();
    let length = 12 + chunks.len() as u32;
    [&b"glTF"[..], &2_u32.to_le_bytes(), &length.to_le_bytes(), &chunks].concat()
}

/// A scene file with a body of a mesh.
fn with_body(file: &str) -> String {
    format!(
        "version = 1\nname = \"wedge\"\n[[bodies]]\nname = \"wedge\"\ndensity = 2000.0\n\
         shape = {{ kind = \"mesh\", mesh = {{ file = \"{file}\", scale = 0.01 }} }}\n"
    )
}

#[test]
fn all_kinds_of_files_give_the_same_solid() {
    let folder = folder("kinds");
    fs::write(folder.join("wedge.obj"), obj(&FACES)).unwrap_or_else(|error| panic!("{error}"));
    fs::write(folder.join("wedge.stl"), stl()).unwrap_or_else(|error| panic!("{error}"));
    fs::write(folder.join("wedge.glb"), glb()).unwrap_or_else(|error| panic!("{error}"));
    for file in ["wedge.obj", "wedge.stl", "wedge.glb"] {
        let path = folder.join("scene.toml");
        fs::write(&path, with_body(file)).unwrap_or_else(|error| panic!("{error}"));
        let scene = Scene::from_path(&path).unwrap_or_else(|error| panic!("{file}: {error}"));
        let ShapeKind::Mesh { mesh, .. } = &scene.bodies[0].shape else { panic!("a mesh") };
        let solid = mesh.solid().unwrap_or_else(|error| panic!("{file}: {error}"));
        assert!((solid.volume() / VOLUME - 1.0).abs() < 1e-5, "{file}: {}", solid.volume());
        let mass =
            1.0 / World::new(&scene).unwrap_or_else(|error| panic!("{error}")).bodies()[0].inverse_mass;
        assert!((mass - 0.06).abs() < 1e-5, "{file}: {mass} kg");
        // The scene is complete: its text needs no file.
        let text = scene.to_toml().unwrap_or_else(|error| panic!("{error}"));
        let again = Scene::from_toml(&text, "elsewhere/scene.toml").unwrap_or_else(|error| panic!("{error}"));
        assert!(!text.contains(file) && again == scene);
    }
}

#[test]
fn bad_meshes_are_errors_with_file_key_and_reason() {
    let folder = folder("bad");
    let inverted = FACES.map(|[a, b, c]| [a, c, b]);
    let mut one_inverted = FACES;
    one_inverted[3].swap(0, 1);
    // Each of two nodes is a child of the other.
    let circle = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"children": [1]}, {"children": [0]}]}"#
        .to_owned();
    let cases = [
        ("holes.obj", obj(&FACES[..7]), "holes"),
        ("inverted.obj", obj(&inverted), "point inwards"),
        ("one_inverted.obj", obj(&one_inverted), "disagree"),
        ("empty.obj", String::new(), "no triangles"),
        ("nan.obj", obj(&FACES).replacen("v 0 0 0", "v nan 0 0", 1), "bodies[0].shape.mesh"),
        ("words.obj", "f a b c\n".to_owned(), "bodies[0].shape.mesh.file"),
        ("short.glb", "glTF".to_owned(), "bodies[0].shape.mesh.file"),
        ("wedge.ply", obj(&FACES), ".obj, .stl, .gltf or .glb"),
        ("circle.gltf", circle, "must form trees"),
        ("large.obj", obj(&FACES.repeat(12_501)), "at most 100000"),
    ];
    for (file, text, reason) in cases {
        fs::write(folder.join(file), text).unwrap_or_else(|error| panic!("{error}"));
        let path = folder.join("scene.toml");
        fs::write(&path, with_body(file)).unwrap_or_else(|error| panic!("{error}"));
        let error = Scene::from_path(&path).expect_err(file).to_string();
        assert!(error.contains("bodies[0].shape.mesh") && error.contains(reason), "{file}: {error}");
        assert!(error.contains("scene.toml:6:"), "{file}: {error}");
    }
    let path = folder.join("scene.toml");
    fs::write(&path, with_body("absent.stl")).unwrap_or_else(|error| panic!("{error}"));
    let error = Scene::from_path(&path).expect_err("no such file").to_string();
    assert!(error.contains("absent.stl") && error.contains("bodies[0].shape.mesh.file"), "{error}");
    // Negative control: the same file without its defect.
    fs::write(folder.join("good.obj"), obj(&FACES)).unwrap_or_else(|error| panic!("{error}"));
    fs::write(&path, with_body("good.obj")).unwrap_or_else(|error| panic!("{error}"));
    assert!(Scene::from_path(&path).is_ok());
}

/// A ball of triangles, a subdivided octahedron, in units of its own.
fn ball(rounds: u32) -> Mesh {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let vertices: Vec<Vec3> = axes.iter().flat_map(|axis| [-*axis, *axis]).collect();
    let faces: [[usize; 3]; 8] =
        [[1, 3, 5], [3, 0, 5], [0, 2, 5], [2, 1, 5], [3, 1, 4], [0, 3, 4], [2, 0, 4], [1, 2, 4]];
    let mut triangles: Vec<[Vec3; 3]> = faces.iter().map(|face| face.map(|index| vertices[index])).collect();
    for _ in 0..rounds {
        triangles = triangles
            .iter()
            .flat_map(|[a, b, c]| {
                let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(from, to)| (*from + *to).normalize());
                [[*a, ab, ca], [ab, *b, bc], [ca, bc, *c], [ab, bc, ca]]
            })
            .collect();
    }
    let numbers = (0..triangles.len() as u32).map(|index| [3 * index, 3 * index + 1, 3 * index + 2]);
    Mesh { triangles: numbers.collect(), vertices: triangles.concat(), ..Mesh::default() }
}

#[test]
fn a_sponge_of_a_ball_is_as_large_as_an_ellipsoid() {
    let volume = |shape: BlockShape| {
        let sponge = Sponge { shape, cells: UVec3::splat(12), ..Sponge::new("ball", Vec3::ZERO) };
        let world = common::world(&Scene::new("ball").with_sponge(sponge));
        world.measures().sponge_volume
    };
    let (mesh, ellipsoid) = (volume(BlockShape::Mesh { mesh: ball(4) }), volume(BlockShape::Ellipsoid));
    assert!((mesh / ellipsoid - 1.0).abs() < 0.02, "{mesh} and {ellipsoid} m^3");
    // Negative controls: the block, and an octahedron, which is a ball of no rounds.
    let (block, octahedron) = (volume(BlockShape::Block), volume(BlockShape::Mesh { mesh: ball(0) }));
    assert!(block > 1.7 * ellipsoid && octahedron < 0.5 * ellipsoid, "{block} and {octahedron} m^3");
}

/// Particles of a block of water of a shape, 12 cm wide, in a container; of a pour of it where that is asked for.
fn particles(shape: BlockShape, is_poured: bool) -> usize {
    let (low, high) = (Vec3::splat(-0.06), Vec3::splat(0.06));
    let block = FluidBlock { shape: shape.clone(), ..FluidBlock::new(low, high) };
    let blocks = if is_poured { Vec::new() } else { vec![block] };
    let fluid = Fluid { blocks, spacing: 0.005, ..Fluid::default() };
    let scene = Scene::new("shapes").in_box(Vec3::splat(-0.1), Vec3::splat(0.1)).with_fluid(fluid);
    let mut world = common::world(&scene);
    if is_poured {
        let region = Region::Block { minimum: low, maximum: high, shape: Box::new(shape) };
        let command = Command::Pour { region, velocity: Vec3::ZERO };
        world.push(command).unwrap_or_else(|error| panic!("{error}"));
        common::frame(&mut world);
    }
    world.particle_count()
}

#[test]
fn blocks_of_water_have_shapes() {
    for is_poured in [false, true] {
        let count = |shape: BlockShape| particles(shape, is_poured) as f64;
        let whole = count(BlockShape::Block);
        assert_eq!(whole, 24.0 * 24.0 * 24.0);
        let mesh = BlockShape::Mesh { mesh: ball(4) };
        for (shape, share) in [
            (BlockShape::Ellipsoid, std::f64::consts::FRAC_PI_6),
            (BlockShape::Cylinder { axis: Axis::Z }, std::f64::consts::FRAC_PI_4),
            (mesh, std::f64::consts::FRAC_PI_6),
        ] {
            let found = count(shape.clone()) / whole;
            assert!((found / share - 1.0).abs() < 0.03, "{is_poured}: {found} of {share}");
        }
        // The control: an octahedron, which is a ball of no rounds, is a third of its box less than that.
        assert!(count(BlockShape::Mesh { mesh: ball(0) }) < 0.2 * whole);
    }
}

#[test]
fn shapes_of_water_that_are_no_meshes_are_refused() {
    let mut open = ball(1);
    open.triangles.pop();
    let scene = |mesh: Mesh| {
        let shape = BlockShape::Mesh { mesh };
        let block = FluidBlock { shape, ..FluidBlock::new(Vec3::splat(-0.05), Vec3::splat(0.05)) };
        Scene::new("open").with_fluid(Fluid { blocks: vec![block], ..Fluid::default() })
    };
    let error = scene(open.clone()).validate().map_err(|error| error.to_string()).unwrap_err();
    assert!(error.contains("fluid.blocks[0].shape.mesh.triangles"), "{error}");
    assert!(scene(ball(1)).validate().is_ok());
    let mut world = common::world(&scene(ball(1)));
    let mut pour = |mesh: Mesh| {
        let shape = Box::new(BlockShape::Mesh { mesh });
        let region = Region::Block { minimum: Vec3::splat(0.06), maximum: Vec3::splat(0.2), shape };
        world.push(Command::Pour { region, velocity: Vec3::ZERO }).map_err(|error| error.to_string())
    };
    let error = pour(open).unwrap_err();
    assert!(error.contains("pour.region.block.shape.mesh.triangles"), "{error}");
    assert_eq!(pour(ball(1)), Ok(()));
}

#[test]
fn the_skin_of_a_sponge_is_its_mesh_and_goes_with_it() {
    let mesh = ball(3);
    let shape = BlockShape::Mesh { mesh: mesh.clone() };
    let sponge = Sponge { shape, cells: UVec3::splat(6), ..Sponge::new("ball", Vec3::new(0.0, 0.1, 0.0)) };
    let mut world = common::world(&Scene::new("ball").with_sponge(sponge));
    let places = |world: &World| -> Vec<Vec3> {
        let skin = world.skin(0.into()).unwrap_or_else(|| panic!("no skin"));
        skin.positions(world.node_positions()).collect()
    };
    let at_rest = places(&world);
    let middle = Vec3::new(0.03, 0.13, 0.03);
    let off = |place: &Vec3, radius: f32| (place.distance(middle) - radius).abs();
    assert!(at_rest.iter().all(|place| off(place, 0.03) < 1e-5), "corners of a ball of 3 cm");
    // The control: the surface of the lattice is farther off.
    let lattice = world.lattice();
    let place = |row: [f32; 4]| Vec3::new(row[0], row[1], row[2]);
    let corners = lattice.triangles.iter().flatten().map(|node| place(lattice.position[*node as usize]));
    assert!(corners.map(|corner| off(&corner, 0.03)).fold(0.0, f32::max) > 2e-3);
    let skin = world.skin(0.into()).unwrap_or_else(|| panic!("no skin"));
    assert_eq!(skin.triangles().len(), mesh.triangles.len());
    let ones = vec![0.25; lattice.node_count()];
    assert!(skin.values(&ones).all(|value| (value - 0.25).abs() < 1e-6));
    // Put elsewhere and turned, it is the same ball.
    let (position, rotation) = (Vec3::new(0.5, 0.2, -0.3), Quat::from_rotation_z(1.0));
    let (sponge, velocity) = (0.into(), Vec3::ZERO);
    let command = Command::PlaceSponge { sponge, position, rotation, velocity };
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
    common::steps(&mut world, 1);
    let turned = places(&world);
    let expected = at_rest.iter().map(|place| position + rotation * (*place - middle));
    let farthest = turned.iter().zip(expected).map(|(a, b)| a.distance(b)).fold(0.0, f32::max);
    assert!(farthest < 1e-4, "{farthest} m");
    assert!(world.skin(1.into()).is_none());
    let block = Scene::new("block").with_sponge(Sponge::new("block", Vec3::ZERO));
    assert!(common::world(&block).skin(0.into()).is_none());
}
