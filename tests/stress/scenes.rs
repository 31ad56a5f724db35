//! Scenes of the cases: small, at the default settings.

use sorb::{
    glam::{UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Sponge},
};

/// Half of the width of the cubic box \[m\].
pub(crate) const BOX: f32 = 0.06;

/// Speed of elastic waves in the dry sponge \[m/s\]: released nodes spring back as fast.
pub(crate) const WAVE: f64 = 20.0;

/// Distance of the particles \[m\].
const SPACING: f32 = 0.006;

/// A dry sponge of 5 cm on the floor of a box.
pub(crate) fn dry() -> Scene {
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    Scene::new("dry").in_box(corner, Vec3::new(BOX, 2.0 * BOX, BOX)).with_sponge(Sponge {
        edge: 0.012,
        cells: UVec3::splat(4),
        ..Sponge::new("sponge", Vec3::new(-0.024, 0.0, -0.024))
    })
}

/// The same, half full, in a pool.
pub(crate) fn wet() -> Scene {
    let corner = Vec3::new(-BOX, 0.0, -BOX);
    let mut scene = Scene { name: "wet".to_owned(), ..dry() }.with_fluid(Fluid {
        spacing: SPACING,
        blocks: vec![FluidBlock::new(corner, Vec3::new(BOX, 0.012, BOX))],
        ..Fluid::default()
    });
    scene.sponges[0].saturation = 0.5;
    scene
}

/// The pool without the sponge.
pub(crate) fn pool() -> Scene {
    Scene { name: "pool".to_owned(), sponges: Vec::new(), ..wet() }
}

/// A ball of 3 cm above the sponge.
pub(crate) fn with_ball(scene: Scene, density: f32, speed: f32) -> Scene {
    let ball = Body {
        linear_velocity: Vec3::NEG_Y * speed,
        ..Body::dynamic("ball", ShapeKind::Sphere { radius: 0.015 }, Vec3::Y * 0.08, density)
    };
    scene.with_body(ball)
}

/// Plates that close from both sides of some axes to a gap within 0.2 s, stay for 0.1 s, and open again until 0.5 s.
pub(crate) fn crushed(mut scene: Scene, axes: &[usize], gap: f32) -> Scene {
    // Away from the floor, so that a plate fits below.
    scene.sponges[0].position.y = 0.036;
    let sponge = &scene.sponges[0];
    let (centre, half, thickness) = (sponge.position + 0.5 * sponge.size(), 0.5 * sponge.size(), 0.004);
    for axis in axes {
        for (name, sign) in [("low", -1.0_f32), ("high", 1.0)] {
            let mut unit = Vec3::ZERO;
            unit[*axis] = sign;
            let mut half_extents = Vec3::splat(0.03);
            half_extents[*axis] = thickness;
            let way = half[*axis] - 0.5 * gap;
            let motion =
                |velocity: Vec3, start: f32| Motion::Linear { velocity, start, end: start + 0.2, ease: 0.0 };
            let motions = vec![motion(-unit * (way / 0.2), 0.0), motion(unit * (way / 0.2), 0.3)];
            let position = centre + unit * (half[*axis] + thickness);
            let shape = ShapeKind::Cuboid { half_extents };
            scene = scene.with_body(Body::kinematic(&format!("{name}{axis}"), shape, position, motions));
        }
    }
    scene
}

/// Straight motions back and forth along an axis: `count` times, each way for `time` seconds.
pub(crate) fn shaken(velocity: Vec3, time: f32, count: u16) -> Vec<Motion> {
    let way = |index: u16| {
        let start = time * f32::from(index);
        let sign = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
        Motion::Linear { velocity: velocity * sign, start, end: start + time, ease: 0.0 }
    };
    (0..2 * count).map(way).collect()
}
