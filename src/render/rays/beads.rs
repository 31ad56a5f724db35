//! Balls of the views that show particles or nodes.

use super::tree::{Ball, Tree};
use crate::render::View;
use crate::render::colour::{colour_map, smooth};
use crate::render::stage::Stage;
use glam::Vec3;

const WATER: Vec3 = Vec3::new(0.020, 0.125, 0.36);
const FAST_WATER: Vec3 = Vec3::new(0.07, 0.33, 0.62);
const FOAM: Vec3 = Vec3::new(0.66, 0.83, 0.93);
const DRY: Vec3 = Vec3::new(0.90, 0.62, 0.20);
const SOAKED: Vec3 = Vec3::new(0.34, 0.16, 0.03);
/// Radius of a node over the distance of nodes.
const NODE: f32 = 0.2;
/// Thickness of the layer of particles on a section, in radii of particles, in front of it and behind it.
const SECTION: (f32, f32) = (0.6, 2.0);

#[cfg(feature = "gpu")]
shared_with_shaders!(BEADS: WATER, FAST_WATER, FOAM, SECTION);

/// Balls with their colours: linear red, green and blue.
#[derive(Debug)]
pub(super) struct Beads {
    pub(super) tree: Tree<Ball>,
    pub(super) balls: Vec<Ball>,
    pub(super) colours: Vec<Vec3>,
}

/// The balls of a view; none for views of surfaces.
pub(super) fn beads(stage: &Stage<'_>) -> Option<Beads> {
    let picture = stage.picture;
    let (balls, colours) = match picture.view {
        View::Realistic | View::Fast | View::Superimposed | View::Saturation => return None,
        View::Nodes => nodes(stage),
        View::Particles => particles(stage, |_, _| true, |index| water(stage.speed(index))),
        View::Speed => particles(
            stage,
            |_, _| true,
            |index| colour_map(stage.velocity(index) / picture.range.1.max(f32::MIN_POSITIVE)),
        ),
        View::Pressure => particles(
            stage,
            |_, _| true,
            |index| {
                let value = picture.pressures.get(index).copied().unwrap_or(0.0);
                let (low, high) = picture.range;
                colour_map((value - low) / (high - low).max(f32::MIN_POSITIVE))
            },
        ),
        View::Cutaway => {
            let near = |_, place: Vec3| {
                picture.section.is_some_and(|(point, normal)| {
                    let height = (place - point).dot(normal) / stage.radius;
                    height < SECTION.0 && height > -SECTION.1
                })
            };
            particles(stage, near, |index| water(stage.speed(index)))
        }
    };
    Some(Beads { tree: Tree::new(balls.iter().copied()), balls, colours })
}

fn particles(
    stage: &Stage<'_>,
    chosen: impl Fn(usize, Vec3) -> bool,
    colour: impl Fn(usize) -> Vec3,
) -> (Vec<Ball>, Vec<Vec3>) {
    let chosen = stage.particles.iter().filter(|(index, place)| chosen(*index, *place));
    chosen.map(|(index, place)| ((*place, stage.radius), colour(*index))).unzip()
}

/// Nodes in the colour of their wetness.
pub(in crate::render) fn nodes(stage: &Stage<'_>) -> (Vec<Ball>, Vec<Vec3>) {
    let picture = stage.picture;
    let place = |row: usize| picture.nodes.get(row).map(|&[x, y, z, _]| Vec3::new(x, y, z));
    let length = |pair: [u32; 2]| {
        let [a, b] = pair.map(|row| place(row as usize).unwrap_or(Vec3::ZERO));
        a.distance(b)
    };
    let lengths: Vec<f32> = picture.triangles.iter().map(|[a, b, _]| length([*a, *b])).collect();
    let mean = lengths.iter().sum::<f32>() / lengths.len().max(1) as f32;
    let radius = if mean > 0.0 && mean.is_finite() { NODE * mean } else { stage.radius };
    let drawn = (0..picture.nodes.len()).filter_map(|row| Some((row, place(row).filter(|p| p.is_finite())?)));
    drawn
        .map(|(row, place)| {
            let wetness = stage.sponge.wetness.get(row).copied().unwrap_or(0.0);
            ((place, radius), DRY.lerp(SOAKED, smooth(0.03, 0.75, wetness)))
        })
        .unzip()
}

/// Colour of water of a speed, 0 (still) to 1.
fn water(speed: f32) -> Vec3 {
    let slow = WATER.lerp(FAST_WATER, smooth(0.0, 0.5, speed));
    slow.lerp(FOAM, smooth(0.35, 1.0, speed))
}
