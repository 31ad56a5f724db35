//! The realistic view: rays from the eye through water, sponges and bodies in a room.
//!
//! One file is one pass or one thing that rays meet. There are maps of light on the floor (`photons`, `ground`), and the next event of a
//! ray (`setting`, `tree`). Others are what solids look like (`matter`, `skin`, `foam`), paths (`path`, `optics`, `room`) and pixels.

mod beads;
mod foam;
mod ground;
mod matter;
mod optics;
mod path;
mod photons;
mod pixels;
mod room;
mod screen;
mod setting;
mod shells;
mod skin;
#[cfg(test)]
mod tests;
pub(super) mod tree;

#[cfg(feature = "gpu")]
pub(super) use {
    beads::nodes as node_balls,
    foam::foam,
    ground::Ground,
    path::tint,
    room::key_direction,
    screen::{COARSE, PASSES},
    tree::Triangle,
};

use super::camera::Raster;
use super::colour::displayed;
use super::stage::Stage;
use super::water::{self, Field, Water};
use super::{Camera, Image, Picture, View};
use glam::Vec3;
#[cfg(not(feature = "gpu"))]
use ground::Ground;
use optics::Medium;
use pixels::{Effort, STRIDE};
use screen::Screen;
use setting::{Coat, Setting};
use tree::{Ball, Tree};

/// Texels along a side of the maps of light on the floor; those of the fast view.
const TEXELS: usize = 240;
const FEW_TEXELS: usize = 144;

/// Constants that shaders know.
#[cfg(feature = "gpu")]
pub(super) const CONSTANTS: &[&[super::shared::Constant]] = &[
    beads::CONSTANTS,
    foam::CONSTANTS,
    matter::CONSTANTS,
    optics::CONSTANTS,
    path::CONSTANTS,
    photons::CONSTANTS,
    pixels::CONSTANTS,
    room::CONSTANTS,
    screen::CONSTANTS,
    setting::CONSTANTS,
    shells::CONSTANTS,
    skin::CONSTANTS,
];

/// Texels along a side of the maps of a view.
pub(super) fn texels(view: View) -> usize {
    if view == View::Fast { FEW_TEXELS } else { TEXELS }
}

/// How many rays a picture of a view takes.
fn effort(view: View) -> Effort {
    if view == View::Fast { Effort::LITTLE } else { Effort::FULL }
}

/// Places of the rays that a pixel at an edge gets, in pixels.
#[cfg(feature = "gpu")]
pub(super) fn added(view: View) -> &'static [(f32, f32)] {
    effort(view).added
}

/// Draws the picture.
pub(super) fn draw(picture: &Picture<'_>, camera: &Camera, width: u32, height: u32) -> Image {
    draw_with(picture, camera, (width, height), |_| ())
}

/// The same with a ray for every pixel, as other renderers draw.
#[cfg(all(test, feature = "gpu", feature = "serde"))]
pub(super) fn draw_every_pixel(picture: &Picture<'_>, camera: &Camera, width: u32, height: u32) -> Image {
    draw_with(picture, camera, (width, height), |watched| watched.fill(true))
}

/// Densities of the water on their grid, and the maps of light, shadows of solids and ways to water on the floor.
#[cfg(all(test, feature = "gpu", feature = "serde"))]
pub(super) fn maps(stage: &Stage<'_>) -> (Vec<f32>, Vec<glam::Vec4>, Vec<f32>, Vec<f32>) {
    let (setting, _) = prepare(stage);
    let values = setting.field.map(Field::into_values).unwrap_or_default();
    (values, setting.ground.arriving, setting.ground.solid, setting.ground.water)
}

fn draw_with(
    picture: &Picture<'_>,
    camera: &Camera,
    (width, height): (u32, u32),
    watch: impl FnOnce(&mut [bool]),
) -> Image {
    let (columns, rows) = (width as usize, height as usize);
    let stage = Stage::new(picture, camera, columns, rows);
    let (setting, mut watched) = prepare(&stage);
    watch(&mut watched);
    let raster = &stage.raster;
    let screen = (picture.view == View::Fast).then(|| Screen::new(&stage));
    let effort = effort(picture.view);
    let pixels = pixels::pixels((columns, rows), &watched, effort, |x, y| {
        let (right, up) = raster.slopes(x - 0.5, y - 0.5);
        let direction = (raster.forward + raster.right * right + raster.up * up).normalize();
        let (light, signature) = match (&screen, picture.view) {
            (Some(screen), _) => setting.by_screen(screen, (x, y), direction),
            (None, View::Superimposed) => setting.superimposed(raster.eye, direction),
            (None, _) => setting.radiance(raster.eye, direction),
        };
        (displayed(light), signature)
    });
    Image { width, height, pixels }
}

/// The passes before the first ray.
fn prepare<'a>(stage: &'a Stage<'a>) -> (Setting<'a>, Vec<bool>) {
    let view = stage.picture.view;
    let water = match view {
        View::Realistic | View::Superimposed => water(stage),
        _ => None,
    };
    let (field, drops, films) = match water {
        Some(Water { field, drops, films }) => (Some(field), drops, films),
        None => (None, Vec::new(), Vec::new()),
    };
    let (low, high) = stage.around;
    let ground = stage.ground();
    let height = ground.map_or(low.y, |(height, _)| height);
    let side = texels(view);
    let which = |clear: bool| {
        let floor = ground.and_then(|(_, body)| body);
        let indices = 0..stage.solids.len();
        indices.filter(|i| stage.solids[*i].is_clear() == clear && Some(*i) != floor).collect()
    };
    let sponge = &stage.sponge;
    let hides_sponge = matches!(view, View::Nodes | View::Particles | View::Pressure | View::Speed);
    let triangles = if hides_sponge { &[][..] } else { &sponge.triangles[..] };
    let mut setting = Setting {
        stage,
        nudge: 0.06 * field.as_ref().map_or(stage.radius.max(1e-4), Field::cell),
        field,
        films,
        tree: Tree::new(triangles.iter().map(|(_, corners)| corners.map(|node| sponge.positions[node]))),
        beads: beads::beads(stage),
        coat: if view == View::Saturation { Coat::Map } else { Coat::Skin },
        medium: Medium { absorption: stage.picture.absorption, scatter: stage.picture.scatter },
        ground: Ground::new((height, ground.is_some()), side, (low, high)),
        opaque: which(false),
        clear: which(true),
        pitch: stage.pitch(),
        centre: (low + high) * 0.5,
        size: (high - low).length(),
        pixel: 1.0 / stage.raster.focal,
    };
    setting.light_up();
    let balls = setting.beads.iter().flat_map(|beads| &beads.balls);
    let small = drops.iter().map(|drop| (drop.centre, drop.radius)).chain(balls.copied());
    let watched = watched(&stage.raster, small);
    (setting, watched)
}

/// The free water.
fn water(stage: &Stage<'_>) -> Option<Water> {
    let positions: Vec<Vec3> = stage.particles.iter().map(|(_, place)| *place).collect();
    let input = water::Input {
        positions: &positions,
        free: &stage.free,
        spacing: 2.0 * stage.radius,
        container: stage.container,
        sponge: &stage.sponge,
        bodies: &stage.solids,
    };
    water::water(&input)
}

/// The blocks of pixels that small balls are in: middles and radii (m).
fn watched(raster: &Raster, balls: impl Iterator<Item = Ball>) -> Vec<bool> {
    let (columns, rows) = (raster.width.div_ceil(STRIDE), raster.height.div_ceil(STRIDE));
    let mut blocks = vec![false; columns * rows];
    for (centre, radius) in balls {
        let local = raster.local(centre);
        if local.z < raster.near {
            continue;
        }
        let (x, y) = raster.project(local);
        let reach = radius * raster.focal / local.z + 1.0;
        // Balls of many pixels are found by the rays of the first pass.
        if reach > 3.0 * STRIDE as f32 {
            continue;
        }
        let range = |middle: f32, count: usize| {
            let first = ((middle - reach).max(0.0) as usize / STRIDE).min(count);
            let end = if middle + reach < 0.0 { 0 } else { (middle + reach) as usize / STRIDE + 1 };
            first..end.min(count)
        };
        for row in range(y, rows) {
            for block in range(x, columns) {
                blocks[row * columns + block] = true;
            }
        }
    }
    blocks
}
