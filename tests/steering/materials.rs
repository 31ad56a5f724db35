//! Materials that change.

use sorb::{
    Command,
    glam::Vec3,
    scene::{Material, Scene, Sponge},
};

use super::{audit, common, pool, push, refused};

/// A material of all that can change.
fn other() -> Material {
    Material {
        density: 80.0,
        porosity: 0.8,
        permeability: 5e-9,
        forchheimer: 0.2,
        entry_pressure: 300.0,
        young_modulus: 8000.0,
        poisson_ratio: 0.3,
        damping: 1e-3,
        iterations: 6,
        friction: 0.2,
        softening: 0.5,
        swelling: 0.1,
        wetting_time: 0.2,
        relative_permeability_exponent: 2,
        receding_pressure: 600.0,
        ..Material::default()
    }
}

#[test]
fn a_material_from_the_start_is_that_of_the_scene() {
    let mut scene = pool();
    let mut changed = common::world(&scene);
    push(&mut changed, Command::Material { sponge: 1.into(), material: other() });
    other().put(&mut scene.sponges[1]);
    let (mut built, mut without) = (common::world(&scene), common::world(&pool()));
    for _ in 0..8 {
        [&mut changed, &mut built, &mut without].into_iter().for_each(common::frame);
        audit(&changed);
        assert_eq!(changed.state_digest(), built.state_digest());
    }
    assert_eq!(changed.material(1.into()), Some(other()));
    let mut expected = built.scene().clone();
    // Those that the world began with stay, whatever the material becomes.
    expected.fluid.as_mut().expect("a pool").coupling_weights = Some(built.scene().coupling_weights());
    assert_eq!(changed.scene(), &expected);
    assert_ne!(changed.state_digest(), without.state_digest(), "the control: the material of before");
    // Back to what it was: what depends on wetness goes.
    push(&mut changed, Command::Material { sponge: 1.into(), material: Material::default() });
    for _ in 0..4 {
        common::frame(&mut changed);
        audit(&changed);
    }
}

#[test]
fn a_sponge_that_becomes_soft_sags() {
    let scene =
        Scene::new("floor").in_box(Vec3::new(-0.05, 0.0, -0.05), Vec3::new(0.05, 0.1, 0.05)).with_sponge(
            Sponge { cells: [4, 4, 4].into(), ..Sponge::new("sponge", Vec3::new(-0.02, 0.0, -0.02)) },
        );
    let mut world = common::world(&scene);
    let top = |world: &sorb::World| world.node_positions().iter().map(|row| row[1]).fold(0.0, f32::max);
    (0..30).for_each(|_| common::frame(&mut world));
    let before = top(&world);
    let soft = Material { young_modulus: 200.0, damping: 0.05, ..Material::default() };
    push(&mut world, Command::Material { sponge: 0.into(), material: soft });
    (0..90).for_each(|_| common::frame(&mut world));
    // rho g H^2 / (2 E) is 2 mm.
    let sag = before - top(&world);
    assert!((1e-3..3e-3).contains(&sag), "{sag} m");
    push(&mut world, Command::Material { sponge: 0.into(), material: Material::default() });
    (0..60).for_each(|_| common::frame(&mut world));
    assert!((top(&world) - before).abs() < 1e-4, "it is back: {}", top(&world));
}

#[test]
fn bad_materials_are_refused_as_in_a_scene() {
    let mut world = common::world(&pool());
    let before = world.digest();
    for (change, key) in [
        (
            &(|material: &mut Material| material.permeability = 1e-20) as &dyn Fn(&mut Material),
            "permeability",
        ),
        (&|material| material.young_modulus = f32::NAN, "young_modulus"),
        (&|material| material.poisson_ratio = 0.5, "poisson_ratio"),
        (&|material| material.iterations = 0, "iterations"),
        (&|material| material.receding_pressure = 10.0, "receding_pressure"),
    ] {
        let mut material = Material::default();
        change(&mut material);
        let mut scene = pool();
        material.put(&mut scene.sponges[0]);
        let expected = scene.problems()[0].to_string().replace("sponges[0].", "material.");
        let text = refused(&mut world, Command::Material { sponge: 0.into(), material });
        // A key of another one that a rule names is that of the scene.
        let found = text.replace("sponges[0].", "material.");
        assert!(
            found.contains(&expected) && found.contains(&format!("`material.{key}`")),
            "{expected}: {text}"
        );
    }
    let text = refused(&mut world, Command::Material { sponge: 5.into(), material: Material::default() });
    assert!(text.contains("`material.sponge` = 5: no such sponge"), "{text}");
    assert_eq!(world.digest(), before, "nothing has changed");
}
