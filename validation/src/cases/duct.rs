//! Water and sponge in a duct: common parts of the one-dimensional porous cases.

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Scene, ShapeKind, Sponge, Time},
};

use crate::{
    case::{Failure, Setting},
    level::heights,
    norms::mean,
    references::darcy::Pores,
    solver::Material,
};

/// Width of the duct \[m\].
const WIDTH: f64 = 0.04;
/// A stiff sponge, heavy enough that the water bounds the steps.
pub(super) const STIFF: Material = Material { young: 5e5, poisson: 0.2, density: 2000.0 };

/// Pores and water of the cases.
pub(super) fn pores(permeability: f64, entry_pressure: f64) -> Pores {
    Pores { permeability, porosity: 0.9, entry_pressure, viscosity: 1e-3, density: 1000.0 }
}

/// Sizes of a case.
#[derive(Clone, Copy, Debug)]
pub(super) struct Duct {
    /// Edge of a lattice cell \[m\].
    pub(super) edge: f64,
    /// Distance of particles \[m\].
    pub(super) spacing: f64,
    /// Cells across the duct.
    width: u32,
    /// Cells along it.
    cells: u32,
}

impl Duct {
    /// A sponge of a length \[m\], with some cells across the duct at full resolution.
    pub(super) fn new(setting: &Setting, length: f64, across: u32) -> Self {
        let width = (setting.count(across) / 2 * 2).max(2);
        let edge = WIDTH / f64::from(width);
        let along = length / edge;
        #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
        #[expect(clippy::cast_sign_loss, reason = "a small whole number")]
        let cells = along.round() as u32;
        Self { edge, spacing: 0.5 * edge, width, cells }
    }

    /// Length of the sponge, and its highest point: the lowest is 0 \[m\].
    pub(super) fn top(&self) -> f64 {
        f64::from(self.cells) * self.edge
    }

    /// Half of the width of the duct \[m\].
    fn half(&self) -> f64 {
        0.5 * f64::from(self.width) * self.edge
    }

    /// Area of the duct \[m^2\].
    pub(super) fn area(&self) -> f64 {
        4.0 * self.half() * self.half()
    }

    /// A vertical duct with the sponge across it.
    ///
    /// The sponge is two cells wider than the duct on each side, which is the reach of a node. The walls hold the nodes
    /// inside them, so that no water passes between sponge and wall. The container below is wider than the duct.
    pub(super) fn scene(
        &self,
        setting: &Setting,
        pores: &Pores,
        gravity: f64,
        (low, high): (f64, f64),
        water: &[(f64, f64)],
    ) -> Result<Scene, Failure> {
        let (half, edge) = (self.half(), self.edge);
        let outer = half + 3.0 * edge;
        let sponge = Sponge {
            edge: edge as f32,
            cells: UVec3::new(self.width + 4, self.cells, self.width + 4),
            permeability: pores.permeability as f32,
            porosity: pores.porosity as f32,
            entry_pressure: pores.entry_pressure as f32,
            // The reference has one capillary pressure at any saturation.
            saturation_gain: 0.0,
            ..Sponge::new("plug", DVec3::new(-half - 2.0 * edge, 0.0, -half - 2.0 * edge).as_vec3())
        };
        let block = |(from, to): &(f64, f64)| {
            FluidBlock::new(DVec3::new(-half, *from, -half).as_vec3(), DVec3::new(half, *to, half).as_vec3())
        };
        let fluid = Fluid {
            spacing: self.spacing as f32,
            viscosity: pores.viscosity as f32,
            blocks: water.iter().map(block).collect(),
            ..Fluid::default()
        };
        let mut scene = Scene {
            gravity: Vec3::new(0.0, -gravity as f32, 0.0),
            time: Time { frame_rate: 100.0, ..Time::default() },
            ..Scene::new("duct")
        }
        .in_box(DVec3::new(-outer, low, -outer).as_vec3(), DVec3::new(outer, high, outer).as_vec3())
        .with_fluid(fluid)
        .with_sponge(sponge);
        let bottom = water.iter().map(|block| block.0).fold(0.0, f64::min);
        for body in self.walls(bottom, high) {
            scene = scene.with_body(body);
        }
        Ok(STIFF.applied(&scene, &setting.solvers)?)
    }

    /// Four plates, which hold the nodes inside them.
    fn walls(&self, low: f64, high: f64) -> [Body; 4] {
        let (half, thickness) = (self.half(), 1.25 * self.edge);
        let (middle, tall) = (0.5 * (low + high), 0.5 * (high - low));
        let plate = |name: &str, x: f64, z: f64| {
            let along = half + 2.0 * thickness;
            let half_extents = if x == 0.0 {
                DVec3::new(along, tall, thickness)
            } else {
                DVec3::new(thickness, tall, along)
            };
            let shape = ShapeKind::Cuboid { half_extents: half_extents.as_vec3() };
            let place = DVec3::new(x * (half + thickness), middle, z * (half + thickness)).as_vec3();
            Body { grip: true, ..Body::fixed(name, shape, place) }
        };
        [
            plate("west", -1.0, 0.0),
            plate("east", 1.0, 0.0),
            plate("north", 0.0, -1.0),
            plate("south", 0.0, 1.0),
        ]
    }

    /// Mean height of the water's surface on the axis of the duct \[m\].
    pub(super) fn surface(&self, world: &World) -> Result<f64, Failure> {
        surface(world, self.half() - self.edge)
    }
}

/// Mean height of the surface within some distance of the axis \[m\].
pub(super) fn surface(world: &World, reach: f64) -> Result<f64, Failure> {
    let at = |index: i32| 0.5 * reach * f64::from(index);
    let points: Vec<_> = (-2..=2).flat_map(|x| (-2..=2).map(move |z| (at(x), at(z)))).collect();
    let found = heights(world, &points);
    if found.is_empty() { Err(Failure::Nothing("the duct is dry".to_owned())) } else { Ok(mean(found)) }
}
