mod motion;
mod rules;

#[cfg(feature = "serde")]
mod errors;
#[cfg(feature = "serde")]
mod overrides;
#[cfg(feature = "serde")]
mod presets;
#[cfg(feature = "serde")]
mod quality;
#[cfg(feature = "serde")]
mod schema;
#[cfg(feature = "serde")]
mod text;

use glam::Vec3;

use super::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge};

/// Valid scene with one of everything.
fn full() -> Scene {
    Scene::new("full")
        .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1))
        .with_fluid(Fluid {
            blocks: vec![FluidBlock::new(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.03, 0.1))],
            ..Fluid::default()
        })
        .with_sponge(Sponge::new("sponge", Vec3::new(-0.04, 0.0, -0.04)))
        .with_body(Body::dynamic(
            "ball",
            ShapeKind::Sphere { radius: 0.02 },
            Vec3::new(0.0, 0.15, 0.0),
            2500.0,
        ))
}

/// The only problem of a scene.
fn only(scene: &Scene) -> super::Problem {
    let problems = scene.problems();
    assert_eq!(problems.len(), 1, "{problems:#?}");
    problems[0].clone()
}
