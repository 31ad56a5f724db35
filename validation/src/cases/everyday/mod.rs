//! What anybody would try first: small scenes, each with a figure from physics.

mod bodies;
mod sponges;
mod water;

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene},
};

pub(super) use bodies::CASE as BODIES;
pub(super) use sponges::CASE as SPONGES;
pub(super) use water::CASE as WATER;

use crate::case::{Failure, Figure, Setting};

/// Gravity that references know \[m/s^2\].
const GRAVITY: f64 = 9.81;
/// Gravity of the scenes with the fault of the cases \[m/s^2\].
const FAULTY_GRAVITY: f64 = 6.0;
/// Density of water \[kg/m^3\].
const DENSITY: f64 = 1000.0;

/// An expectation, and whether quick runs have it.
type Expectation = (bool, fn(&Setting) -> Result<Figure, Failure>);

fn all(setting: &Setting, expectations: &[Expectation]) -> Result<Vec<Figure>, Failure> {
    let chosen = expectations.iter().filter(|(is_quick, _)| *is_quick || !setting.quick);
    chosen.map(|(_, run)| run(setting)).collect()
}

/// Spacing of the particles \[m\].
fn spacing(setting: &Setting) -> f64 {
    0.005 / setting.resolution
}

/// Gravity downwards.
fn gravity(setting: &Setting) -> Vec3 {
    Vec3::new(0.0, -setting.planted(GRAVITY, FAULTY_GRAVITY) as f32, 0.0)
}

/// Blocks of water in a container from the floor on, of half a width and of a height \[m\].
fn tank(setting: &Setting, (half, height): (f32, f32), blocks: Vec<FluidBlock>) -> Scene {
    let fluid = Fluid { spacing: spacing(setting) as f32, blocks, ..Fluid::default() };
    Scene { gravity: gravity(setting), ..Scene::new("everyday") }
        .in_box(Vec3::new(-half, 0.0, -half), Vec3::new(half, height, half))
        .with_fluid(fluid)
}

/// Water in that container up to a depth \[m\].
fn pool(half: f32, depth: f32) -> Vec<FluidBlock> {
    vec![FluidBlock::new(Vec3::new(-half, 0.0, -half), Vec3::new(half, depth, half))]
}

/// Runs a world until a time \[s\], and looks at it after every frame.
fn advance(
    setting: &Setting,
    world: &mut World,
    seconds: f64,
    mut look: impl FnMut(&World),
) -> Result<(), Failure> {
    while world.clock().time < seconds - 1e-6 {
        setting.advance(world)?;
        look(world);
    }
    Ok(())
}

/// The world of a scene at a time \[s\].
fn after(setting: &Setting, scene: &Scene, seconds: f64) -> Result<World, Failure> {
    let mut world = setting.world(scene)?;
    advance(setting, &mut world, seconds, |_| ())?;
    Ok(world)
}

fn place(row: &[f32; 4]) -> Vec3 {
    Vec3::new(row[0], row[1], row[2])
}

/// Mean height of particles or nodes \[m\].
fn mean_height(rows: &[[f32; 4]]) -> f64 {
    rows.iter().map(|row| f64::from(row[1])).sum::<f64>() / rows.len().max(1) as f64
}

/// Lowest and highest place of particles or nodes along y \[m\].
fn reach(rows: &[[f32; 4]]) -> (f64, f64) {
    let heights = rows.iter().map(|row| f64::from(row[1]));
    heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)))
}

/// Share of the particles that something holds for \[1\].
fn share(world: &World, holds: impl Fn(Vec3) -> bool) -> f64 {
    let rows = world.particle_positions();
    rows.iter().filter(|row| holds(place(row))).count() as f64 / rows.len().max(1) as f64
}

/// Mean of something over the frames of the last seconds of a run.
fn mean_over(
    setting: &Setting,
    world: &mut World,
    (from, to): (f64, f64),
    value: impl Fn(&World) -> f64,
) -> Result<f64, Failure> {
    let (mut sum, mut count) = (0.0, 0.0);
    advance(setting, world, to, |world| {
        if world.clock().time > from {
            (sum, count) = (sum + value(world), count + 1.0);
        }
    })?;
    Ok(sum / count)
}
