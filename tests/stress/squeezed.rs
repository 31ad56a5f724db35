//! Sponges that are crushed, turned inside out, or inside each other.

use sorb::{
    glam::{UVec3, Vec3},
    scene::{BlockShape, Body, Motion, Scene, ShapeKind, Sponge},
};

use crate::{
    case::{Case, Check, table},
    pick,
    scenes::{WAVE, crushed, dry, pool, wet},
};

/// Tets that have passed each other may hold each other there.
const TANGLED: &[(Check, &str)] = &[(
    Check::Recovery,
    "let go from a 64th of its volume, a sponge of 4 cells stays tangled, at 0.83 of its volume",
)];

#[test]
fn crushed_flat_and_to_a_point_and_let_go() {
    let mut cases = Vec::new();
    let (flat, rod, point) = (&[1_usize][..], &[0, 2][..], &[0, 1, 2][..]);
    for (scene, name, axes, gap) in [
        (dry(), "flat, to a twelfth", flat, 0.004),
        (dry(), "to a rod, a third by a third", rod, 0.016),
        (dry(), "to a point, a quarter in every direction", point, 0.012),
        (wet(), "flat, to a twelfth", flat, 0.004),
        (wet(), "to a rod, a third by a third", rod, 0.016),
        // Hundreds of neighbours each.
        (wet(), "to a point, a quarter in every direction", point, 0.012),
    ]
    .into_iter()
    .take(pick(5, 6))
    {
        let known = match (scene.fluid.is_some(), axes.len()) {
            (false, 3) => TANGLED,
            _ => &[],
        };
        let name = format!("{}: crushed {name}, and let go", scene.name);
        let case = Case::new(name, crushed(scene, axes, gap), 1.2);
        cases.push(Case { fastest: WAVE, known, recovery: Some((0.5, 0.5)), ..case });
    }
    table(cases);
}

/// One end of a sponge is moved through the other, which inverts every tet between them, and back.
fn inside_out(mut scene: Scene) -> Scene {
    scene.gravity = Vec3::ZERO;
    scene.sponges[0].position.y = 0.03;
    let shape = ShapeKind::Cuboid { half_extents: Vec3::new(0.002, 0.03, 0.03) };
    let place = |x: f32| Vec3::new(x, 0.054, 0.0);
    let way = |sign: f32, start: f32| Motion::Linear {
        velocity: Vec3::X * 0.3 * sign,
        start,
        end: start + 0.2,
        ease: 0.0,
    };
    let left = Body { grip: true, ..Body::fixed("left", shape.clone(), place(-0.024)) };
    let right = Body::kinematic("right", shape, place(0.024), vec![way(-1.0, 0.0), way(1.0, 0.3)]);
    scene.with_body(left).with_body(Body { grip: true, ..right })
}

#[test]
fn turned_inside_out_and_back() {
    let case = |scene: Scene| {
        let name = format!("{}: turned inside out and back", scene.name);
        let case = Case::new(name, inside_out(scene), 1.2);
        // The work of grips is not counted. Tets pass through zero volume, where they are stiff, and spring back as fast.
        Case { fastest: 4.0 * WAVE, excess: None, recovery: Some((0.5, 0.5)), ..case }
    };
    table([case(dry()), case(wet())]);
}

/// Two full sponges at the same place: nodes and particles coincide, to the bit or nearly.
fn doubled(offset: f32) -> Scene {
    let mut scene = pool();
    for (name, shift) in [("one", 0.0), ("other", offset)] {
        scene = scene.with_sponge(Sponge {
            edge: 0.012,
            cells: UVec3::splat(4),
            shape: BlockShape::Ellipsoid,
            saturation: 1.0,
            ..Sponge::new(name, Vec3::new(-0.024 + shift, 0.03, -0.024))
        });
    }
    scene
}

#[test]
fn particles_and_nodes_on_top_of_each_other() {
    let case = |name: &str, offset: f32| {
        // Water of twice its density is driven apart: that energy is in no budget.
        Case { excess: None, ..Case::new(format!("doubled: {name}"), doubled(offset), pick(0.3, 2.0)) }
    };
    // Sponges in contact must not overlap: these have no contact.
    let mut cases = [case("two full sponges in each other", 0.0), case("the same, 1 um apart", 1e-6)];
    for case in &mut cases {
        let refused = sorb::World::new(&case.scene).expect_err("sponges that touch").to_string();
        assert!(refused.contains("overlap"), "{refused}");
        case.scene.sponges[1].solver = sorb::scene::Solver::Sbd;
    }
    table(cases);
}
