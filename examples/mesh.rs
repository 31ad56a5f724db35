//! Meshes: a sponge with the shape of an octahedron drinks in a square bowl that is taken apart into convex parts.
// Prints: ^The sponge of [0-9]+ nodes has drunk [0-9]+ g; [0-9]+ g of [0-9]+ g are in the bowl$

use sorb::{
    World,
    glam::{UVec3, Vec3},
    scene::{BlockShape, Body, Fluid, FluidBlock, Mesh, Scene, ShapeKind, Sponge},
};

/// A square bowl: rings of four corners, from the underside over the rim to the hollow. A file would do as well:
/// `Mesh { file: Some("bowl.obj".into()), ..Mesh::default() }` and `Scene::read_meshes`.
fn bowl() -> Mesh {
    let mut mesh = Mesh::default();
    for (half, y) in [(0.05, 0.0), (0.06, 0.05), (0.05, 0.05), (0.04, 0.01)] {
        for (x, z) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            mesh.vertices.push(Vec3::new(x, y, z));
        }
    }
    mesh.triangles.extend([[0, 1, 2], [0, 2, 3], [12, 14, 13], [12, 15, 14]]);
    for (ring, side) in (0..3).flat_map(|ring| (0..4).map(move |side| (ring, side))) {
        let (a, b) = (4 * ring + side, 4 * ring + (side + 1) % 4);
        mesh.triangles.extend([[a, a + 4, b + 4], [a, b + 4, b]]);
    }
    mesh
}

/// An octahedron, in units of its own: a sponge fills its block as far as it can.
fn octahedron() -> Mesh {
    let vertices = [Vec3::X, Vec3::Y, Vec3::Z].iter().flat_map(|axis| [-*axis, *axis]).collect();
    let triangles =
        vec![[1, 3, 5], [3, 0, 5], [0, 2, 5], [2, 1, 5], [3, 1, 4], [0, 3, 4], [2, 0, 4], [1, 2, 4]];
    Mesh { vertices, triangles, ..Mesh::default() }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let water = FluidBlock::new(Vec3::new(-0.035, 0.02, -0.035), Vec3::new(0.035, 0.045, 0.035));
    let sponge = Sponge {
        cells: UVec3::splat(6),
        shape: BlockShape::Mesh { mesh: octahedron() },
        permeability: 5e-9,
        young_modulus: 2e4,
        ..Sponge::new("octahedron", Vec3::new(-0.03, 0.055, -0.03))
    };
    let shape = ShapeKind::Mesh { mesh: bowl(), parts: 32 };
    let scene = Scene::new("meshes")
        .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.15, 0.1))
        .with_fluid(Fluid { blocks: vec![water], ..Fluid::default() })
        .with_sponge(sponge)
        .with_body(Body::fixed("bowl", shape, Vec3::Y * 0.002));
    let mut world = World::new(&scene)?;
    while world.clock().time < 1.5 {
        world.advance_frame()?;
    }
    let is_in = |row: &&[f32; 4]| row[0].abs().max(row[2].abs()) < 0.055 && row[1] > 0.01;
    let grams = |count: usize| 1e3 * count as f32 * world.particle_mass();
    let held = grams(world.particle_positions().iter().filter(is_in).count());
    let (all, drunk) = (grams(world.particle_count()), 1e3 * world.measures().absorbed_mass);
    assert!(held > 0.99 * all && drunk > 5.0, "{held} g of {all} g, {drunk} g");
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        let nodes = world.node_positions().len();
        println!(
            "The sponge of {nodes} nodes has drunk {drunk:.0} g; {held:.0} g of {all:.0} g are in the bowl"
        );
    }
    Ok(())
}
