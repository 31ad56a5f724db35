//! The realistic view: rays from the eye through water, sponges and bodies in a room.
//!
//! One file is one pass or one thing that rays meet: maps of light on the floor (`photons`, `ground`), the next event of a ray
//! (`setting`, `tree`), what solids look like (`matter`, `skin`, `foam`), paths (`path`, `optics`, `room`) and pixels.

mod foam;
mod ground;
mod matter;
mod optics;
mod path;
mod photons;
mod pixels;
mod room;
mod setting;
mod skin;
mod tree;

use super::camera::Raster;
use super::colour::displayed;
use super::stage::Stage;
use super::water::{self, Drop};
use super::{Camera, Image, Picture};
use glam::Vec3;
use ground::Ground;
use optics::Medium;
use pixels::STRIDE;
use setting::Setting;
use tree::Tree;

/// Draws the picture.
pub(super) fn draw(picture: &Picture<'_>, camera: &Camera, width: u32, height: u32) -> Image {
    let (columns, rows) = (width as usize, height as usize);
    let stage = Stage::new(picture, camera, columns, rows);
    let (setting, drops) = prepare(&stage);
    let raster = &stage.raster;
    let watched = watched(raster, &drops);
    let pixels = pixels::pixels((columns, rows), &watched, |x, y| {
        let (right, up) = raster.slopes(x - 0.5, y - 0.5);
        let direction = raster.forward + raster.right * right + raster.up * up;
        let (light, signature) = setting.radiance(raster.eye, direction.normalize());
        (displayed(light), signature)
    });
    Image { width, height, pixels }
}

/// The passes before the first ray.
fn prepare<'a>(stage: &'a Stage<'a>) -> (Setting<'a>, Vec<Drop>) {
    let positions: Vec<Vec3> = stage.particles.iter().map(|(_, place)| *place).collect();
    let interior: Vec<f32> = stage.particles.iter().map(|(index, _)| stage.interior(*index)).collect();
    let input = water::Input {
        positions: &positions,
        interior: &interior,
        spacing: 2.0 * stage.radius,
        container: stage.container,
        sponge: &stage.sponge,
        bodies: &stage.solids,
    };
    let (field, drops) = match water::field(&input) {
        Some((field, drops)) => (Some(field), drops),
        None => (None, Vec::new()),
    };
    let sponge = &stage.sponge;
    let corners = sponge.triangles.iter().map(|(_, corners)| corners.map(|node| sponge.positions[node]));
    let (low, high) = stage.frame();
    let ground = stage.ground();
    let height = ground.map_or(low.y, |(height, _)| height);
    let which = |clear: bool| {
        let floor = ground.and_then(|(_, body)| body);
        let indices = 0..stage.solids.len();
        indices.filter(|i| stage.solids[*i].is_clear() == clear && Some(*i) != floor).collect()
    };
    let mut setting = Setting {
        stage,
        nudge: 0.06 * field.as_ref().map_or(stage.radius, water::Field::cell),
        field,
        tree: Tree::new(corners),
        medium: Medium { absorption: stage.picture.absorption, scatter: stage.picture.scatter },
        ground: Ground::new(height, ground.is_some(), low, high),
        opaque: which(false),
        clear: which(true),
        pitch: stage.pitch(),
        centre: (low + high) * 0.5,
        size: (high - low).length(),
        pixel: 1.0 / stage.raster.focal,
    };
    setting.light_up();
    (setting, drops)
}

/// The blocks of pixels that drops are in.
fn watched(raster: &Raster, drops: &[Drop]) -> Vec<bool> {
    let (columns, rows) = (raster.width.div_ceil(STRIDE), raster.height.div_ceil(STRIDE));
    let mut blocks = vec![false; columns * rows];
    for drop in drops {
        let local = raster.local(drop.centre);
        if local.z < raster.near {
            continue;
        }
        let (x, y) = raster.project(local);
        let reach = drop.radius * raster.focal / local.z + 1.0;
        // Drops of many pixels are found by the rays of the first pass.
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
