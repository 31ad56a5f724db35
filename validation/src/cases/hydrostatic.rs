//! A column of water at rest: `p = rho g (H - y)`.

use sorb::{
    World,
    glam::Vec3,
    scene::{Fluid, FluidBlock, Scene},
};

use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    level::heights,
    norms::{mean, root_mean_square},
};

/// Hydrostatic pressure.
pub(super) static CASE: Case = Case {
    name: "hydrostatic",
    title: "a column of water stands still under its own weight",
    source: "p = rho g (H - y)",
    subject: Subject::Water,
    control: "gravity half as strong",
    run,
};

/// Depth of the water \[m\]; its width is half of it.
const DEPTH: f64 = 0.4;
/// Particles over the depth.
const LAYERS: u32 = 20;
/// Gravity that the reference assumes \[m/s^2\].
const GRAVITY: f64 = 9.81;

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let spacing = DEPTH / f64::from(setting.count(LAYERS));
    let mut world = setting.world(&scene(setting, spacing))?;
    let seconds = setting.pick(3, 1);
    for _ in 0..seconds * 60 {
        setting.advance(&mut world)?;
    }
    let measures = world.measures();
    let speed = (GRAVITY * DEPTH).sqrt();
    let (single, layers) = pressure_errors(&world, spacing);
    let level = surface(&world, spacing)?;
    Ok(vec![
        Figure::error("pressure of particles, L2 over the deepest", "1", single, 0.02),
        Figure::error("pressure of layers, L2 over the deepest", "1", layers, 0.02),
        Figure::over("level, error over spacings", "m", (DEPTH, level), spacing, 0.5),
        Figure::error("fastest particle over sqrt(g H)", "1", measures.maximum_speed / speed, 1e-3),
        Figure::error("mean density error", "1", measures.mean_density_error, 5e-4),
    ])
}

fn scene(setting: &Setting, spacing: f64) -> Scene {
    let half = 0.25 * DEPTH as f32;
    let depth = DEPTH as f32;
    let minimum = Vec3::new(-half, 0.0, -half);
    let fluid = Fluid {
        spacing: spacing as f32,
        blocks: vec![FluidBlock::new(minimum, Vec3::new(half, depth, half))],
        ..Fluid::default()
    };
    let gravity = setting.planted(-GRAVITY, -0.5 * GRAVITY) as f32;
    Scene { gravity: Vec3::new(0.0, gravity, 0.0), ..Scene::new("hydrostatic") }
        .in_box(minimum, Vec3::new(half, 1.5 * depth, half))
        .with_fluid(fluid)
}

/// Root mean square error of the pressure over that at the floor, of the particles and of layers a spacing thick.
///
/// The difference between the two is noise between neighbours.
fn pressure_errors(world: &World, spacing: f64) -> (f64, f64) {
    let rest_density = world.scene().fluid.as_ref().map_or(0.0, |fluid| fluid.rest_density);
    let weight = f64::from(rest_density) * GRAVITY;
    let mut layers: Vec<Vec<f64>> = Vec::new();
    for (row, pressure) in world.particle_positions().iter().zip(world.particle_pressures()) {
        let height = f64::from(row[1]);
        #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
        #[expect(clippy::cast_sign_loss, reason = "below the floor is the lowest layer")]
        let layer = (height / spacing).max(0.0) as usize;
        layers.resize_with(layers.len().max(layer + 1), Vec::new);
        layers[layer].push(f64::from(pressure) - weight * (DEPTH - height));
    }
    let single = root_mean_square(layers.iter().flatten().copied());
    let means = layers.iter().filter(|layer| !layer.is_empty()).map(|layer| mean(layer.iter().copied()));
    (single / (weight * DEPTH), root_mean_square(means) / (weight * DEPTH))
}

/// Mean height of the surface, two spacings and more away from the walls.
fn surface(world: &World, spacing: f64) -> Result<f64, Failure> {
    let half = 0.25 * DEPTH - 2.0 * spacing;
    let at = |index: i32| half * f64::from(index) / 4.0;
    let points: Vec<_> = (-4..=4).flat_map(|x| (-4..=4).map(move |z| (at(x), at(z)))).collect();
    let heights = heights(world, &points);
    if heights.is_empty() {
        return Err(Failure::Nothing("no water above the floor".to_owned()));
    }
    Ok(mean(heights))
}
