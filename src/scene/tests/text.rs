use glam::Vec3;

use super::super::*;
use super::full;

/// Scenes that together use every key and variant.
fn scenes() -> Vec<Scene> {
    let mut rich = full();
    rich.title = "Quotes \" and\nlines".to_owned();
    rich.camera = Some(Camera::default());
    rich.sponges[0].shape = BlockShape::Cylinder { axis: Axis::Z };
    rich.sponges[0].permeability = 3.3e-14;
    if let Some(fluid) = &mut rich.fluid {
        fluid.sound_speed = Some(17.3);
        fluid.equation_of_state = EquationOfState::Linear;
    }
    let hull = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let motions = vec![
        Motion::Linear { velocity: Vec3::new(0.1, 1.0 / 3.0, -1e-7), start: 0.3, end: 0.7, ease: 0.0 },
        Motion::Turn { axis: Vec3::X, pivot: Vec3::ZERO, rate: -2.0, start: 0.0, end: 1.0, ease: 0.25 },
    ];
    let capsule = ShapeKind::Capsule { half_height: 0.01, radius: 0.003 };
    let rich = rich
        .with_body(Body::kinematic("hull", ShapeKind::Hull { vertices: hull }, Vec3::ZERO, motions))
        .with_body(Body { rotation: Rotation::new(Vec3::ONE, 12.5), ..Body::fixed("pin", capsule, Vec3::X) })
        .with_body(Body::fixed("floor", ShapeKind::Plane, Vec3::ZERO));
    let channel = Scene::new("channel").in_box(Vec3::ZERO, Vec3::ONE).repeating([true, false, true]);
    let mut all: Vec<Scene> = presets().iter().filter_map(|known| preset(known.name).ok()).collect();
    all.extend([rich, full(), channel, Scene::default()]);
    all
}

#[test]
fn a_written_scene_reads_back_equal() {
    for scene in scenes() {
        let toml = scene.to_toml().expect("writable");
        assert_eq!(
            Scene::from_toml(&toml, "written").unwrap_or_else(|error| panic!("{error}\n{toml}")),
            scene
        );
        let json = scene.to_json().expect("writable");
        assert_eq!(
            Scene::from_json(&json, "written").unwrap_or_else(|error| panic!("{error}\n{json}")),
            scene
        );
    }
    assert_eq!(scenes().len(), presets().len() + 4);
}

#[test]
fn a_written_scene_shows_a_change() {
    let (scene, mut other) = (full(), full());
    other.sponges[0].edge = f32::from_bits(other.sponges[0].edge.to_bits() + 1);
    let text = other.to_toml().expect("writable");
    assert_ne!(Scene::from_toml(&text, "written").expect("valid"), scene);
}

#[test]
fn absent_keys_have_their_defaults() {
    let scene = Scene::from_toml("version = 1\nname = \"scene\"\n", "short").expect("valid");
    assert_eq!(scene, Scene::default());
    let scene = Scene::from_toml("version = 1\n[[sponges]]\nname = \"sponge\"\nedge = 0.01\n", "short")
        .expect("valid");
    assert_eq!(scene.sponges, [Sponge::default()]);
    let json = r#"{"version": 1, "fluid": null, "camera": null, "title": null}"#;
    assert_eq!(Scene::from_json(json, "short").expect("valid"), Scene::default());
}

#[test]
fn whole_numbers_are_numbers() {
    let scene = Scene::from_toml("version = 1\ngravity = [0, -10, 0]\n[time]\nduration = 3\n", "whole")
        .expect("valid");
    assert_eq!((scene.gravity.y, scene.time.duration), (-10.0, 3.0));
}
