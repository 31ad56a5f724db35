//! Common parts of the integration tests: scenes in motion, goldens, and claims.
#![allow(dead_code, reason = "every test binary uses a part of it")]

pub(crate) mod busy;
pub(crate) mod random;
pub(crate) mod resting;

use std::fmt::Display;

use sorb::{
    Options, World,
    glam::{DVec3, Vec3},
    internal,
    scene::{self, Domain, Fluid, FluidBlock, Scene},
};

/// A preset, coarser or finer.
pub(crate) fn preset(name: &str, resolution: f32) -> Scene {
    scene::preset(name)
        .and_then(|scene| scene.scaled(resolution))
        .unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A scene with some keys changed.
pub(crate) fn with(scene: &Scene, keys: &[&str]) -> Scene {
    scene.with_overrides(keys.iter().copied()).unwrap_or_else(|error| panic!("{error}"))
}

/// A vessel that water fills, with or without the topmost tenth.
pub(crate) fn vessel(fill: f32, gravity: Vec3) -> Scene {
    let (low, high) = (Vec3::new(-0.03, 0.0, -0.03), Vec3::new(0.03, 0.06, 0.03));
    let blocks = vec![FluidBlock::new(low, Vec3::new(high.x, fill * high.y, high.z))];
    // A third of a per cent more than there is room for.
    let fluid = Fluid { spacing: 0.006_006, blocks, ..Fluid::default() };
    Scene { gravity, ..Scene::new("vessel") }.in_box(low, high).with_fluid(fluid)
}

/// The world of a scene on two threads, which changes no bit.
pub(crate) fn world(scene: &Scene) -> World {
    let options = Options { threads: Some(2), ..Options::default() };
    World::with_options(scene, &options).unwrap_or_else(|error| panic!("{}: {error}", scene.name))
}

/// Advances by one frame.
pub(crate) fn frame(world: &mut World) {
    if let Err(error) = world.advance_frame() {
        panic!("{}: {error}", world.scene().name);
    }
}

/// Advances by some steps.
pub(crate) fn steps(world: &mut World, count: u32) {
    for _ in 0..count {
        if let Err(error) = world.step() {
            panic!("{}: {error}", world.scene().name);
        }
    }
}

/// Compares a text with `snapshots/{name}.snap`. `INSTA_UPDATE=always cargo test` writes the file anew.
pub(crate) fn golden(name: &str, text: &str) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path("../../snapshots");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}

/// Four significant digits.
pub(crate) fn digits(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.3e}") }
}

/// A position, to a tenth of a millimetre.
pub(crate) fn place(point: DVec3) -> String {
    // Adding zero turns -0.0 into 0.0.
    let [x, y, z] = point.to_array().map(|value| (value * 1e4).round() / 1e4 + 0.0);
    format!("({x:.4}, {y:.4}, {z:.4})")
}

/// The measures of a world that a reader of a golden can judge, in one line.
pub(crate) fn line(world: &World) -> String {
    let m = world.measures();
    let mut text = format!("t {:.4} steps {}", m.time, world.clock().steps);
    let mut add = |name: &str, value: String| text.push_str(&format!(" | {name} {value}"));
    let (fluid, sponge) = (!world.particle_ids().is_empty(), !world.node_positions().is_empty());
    if fluid && sponge {
        add("absorbed", digits(m.absorbed_mass));
        add("saturation", digits(m.saturation));
        add("wicking", digits(m.wicking_height));
    }
    if sponge {
        add("volume", digits(m.sponge_volume));
        add("centre", place(m.sponge_centre));
        add("elastic", digits(m.elastic_energy));
    }
    if fluid {
        add(
            "density error",
            format!("{} max {}", digits(m.mean_density_error), digits(m.maximum_density_error)),
        );
    }
    add("kinetic", digits(m.kinetic_energy));
    add("potential", digits(m.potential_energy));
    add("speed", digits(m.maximum_speed));
    for body in world.bodies() {
        add("body", place(body.state.position.as_dvec3()));
    }
    text
}

/// Conditions of every healthy state. Returns the first one that fails.
pub(crate) fn unhealthy(world: &World, particles: usize) -> Option<String> {
    unhealthy_in(world, world.scene().domain, particles)
}

/// The same, in a given container.
pub(crate) fn unhealthy_in(world: &World, domain: Domain, particles: usize) -> Option<String> {
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    if ids.len() != particles || ids.iter().enumerate().any(|(index, id)| *id as usize != index) {
        return Some(format!(
            "{} particles of {particles}, or their identities are not a permutation",
            ids.len()
        ));
    }
    let points = || world.particle_positions().iter().chain(world.node_positions());
    let speeds = || world.particle_velocities().iter().chain(world.node_velocities());
    if let Some(bad) = points().chain(speeds()).find(|row| !row.iter().all(|value| value.is_finite())) {
        return Some(format!("not finite: {bad:?}"));
    }
    if let Domain::Box { minimum, maximum, .. } = domain {
        // Walls hold particles exactly, and nodes within the softness of one contact pass.
        let slack = Vec3::splat(1e-3);
        let inside = |row: &[f32; 4], slack: Vec3| {
            let point = Vec3::new(row[0], row[1], row[2]);
            point.cmpge(minimum - slack).all() && point.cmple(maximum + slack).all()
        };
        if let Some(bad) = world.particle_positions().iter().find(|row| !inside(row, Vec3::ZERO)) {
            return Some(format!("a particle outside the container: {bad:?}"));
        }
        if let Some(bad) = world.node_positions().iter().find(|row| !inside(row, slack)) {
            return Some(format!("a node outside the container: {bad:?}"));
        }
    }
    None
}

/// Impulse on any body in the last step.
pub(crate) fn bodies_are_pushed(world: &World) -> bool {
    let bodies = &internal::columns(world).bodies;
    let count = world.bodies().len();
    let pushed = |body| {
        [&bodies.fluid_wrenches, &bodies.node_wrenches]
            .iter()
            .any(|wrenches| wrenches.total(body, count).impulse != DVec3::ZERO)
    };
    (0..count).any(pushed)
}

/// Whether any particle is inside a sponge.
pub(crate) fn water_is_inside(world: &World) -> bool {
    let count = world.particle_ids().len();
    internal::columns(world).fluid.interior.iter().take(count).any(|interior| *interior > 0.5)
}

/// Claims about a run: all are checked, then those that do not hold are reported together.
#[derive(Debug, Default)]
pub(crate) struct Claims {
    broken: Vec<String>,
}

impl Claims {
    /// A claim with the figures behind it.
    pub(crate) fn claim(&mut self, holds: bool, what: impl Display) {
        if !holds {
            self.broken.push(what.to_string());
        }
    }

    /// Panics if a claim did not hold.
    pub(crate) fn hold(self) {
        assert!(self.broken.is_empty(), "does not hold:\n  {}", self.broken.join("\n  "));
    }
}
