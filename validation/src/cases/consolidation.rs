//! A soaked sponge in a vessel is pushed down, and settles as the water leaves it.

use std::collections::BTreeMap;

use sorb::{
    World,
    glam::{DVec3, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Motion, Scene, ShapeKind, Sponge, Time},
};

use super::duct::surface;
use crate::{
    case::{Case, Failure, Figure, Setting, Subject},
    norms::{mean, root_mean_square},
    references::terzaghi::Layer,
    solver::Material,
};

/// Consolidation.
pub(super) static CASE: Case = Case {
    name: "consolidation",
    title: "bars push down the top of a soaked sponge in a vessel and hold it, at two permeabilities",
    source: "dw/dt = (K M / mu) d2w/dz2 (Terzaghi; stress relaxation as by Mow et al. 1980)",
    subject: Subject::Coupling,
    control: "three times the permeability",
    run,
};

/// Width of the vessel \[m\], and cells across it at full resolution and in a quick run. The height of the sponge is 1.5
/// times the width.
const WIDTH: f64 = 0.04;
const ACROSS: (u32, u32) = (6, 4);
/// Depth of the water above the sponge \[m\].
const ABOVE: f64 = 0.04;
/// As heavy as water, so that it rests without strain.
const MATERIAL: Material = Material { young: 2e4, poisson: 0.2, density: (1.0 - POROSITY) * WATER };
const POROSITY: f64 = 0.9;
const GRAVITY: f64 = 9.81;
const WATER: f64 = 1000.0;
/// Time in which the water comes to rest \[s\].
const FILLS: f64 = 4.0;
/// Time before the push over which rest is measured \[s\].
const RESTS: f64 = 0.5;
/// Final strain, and the share of the duration over which the top moves.
const STRAIN: f64 = 0.04;
const MOVES: f64 = 0.3;

/// Sizes at a resolution.
struct Vessel {
    cells: UVec3,
    edge: f64,
    layer: Layer,
}

fn run(setting: &Setting) -> Result<Vec<Figure>, Failure> {
    let mut figures = Vec::new();
    for permeability in setting.pick(&[3e-10, 1e-10][..], &[3e-10][..]) {
        let vessel = Vessel::new(setting, *permeability);
        figures.extend(vessel.settle(setting)?);
    }
    Ok(figures)
}

impl Vessel {
    fn new(setting: &Setting, permeability: f64) -> Self {
        let across = (setting.count(setting.pick(ACROSS.0, ACROSS.1)) / 2 * 2).max(2);
        let edge = WIDTH / f64::from(across);
        let along = across + across / 2;
        let still = Layer {
            height: f64::from(along) * edge,
            modulus: MATERIAL.confined(),
            permeability,
            viscosity: 1e-3,
            speed: 0.0,
            moves: 0.0,
        };
        let moves = MOVES * still.duration();
        let layer = Layer { speed: STRAIN * still.height / moves, moves, ..still };
        Self { cells: UVec3::new(across, along, across), edge, layer }
    }

    fn top(&self) -> f64 {
        f64::from(self.cells.y) * self.edge
    }

    fn half(&self) -> f64 {
        0.5 * f64::from(self.cells.x) * self.edge
    }

    fn settle(&self, setting: &Setting) -> Result<Vec<Figure>, Failure> {
        let mut world = setting.world(&self.scene(setting)?)?;
        let mut before = Vec::new();
        while world.clock().time < FILLS {
            setting.advance(&mut world)?;
            if world.clock().time > FILLS - RESTS {
                before.push(self.at_rest(&world)?);
            }
        }
        let (at_rest, end) = (self.middle(&world), FILLS + self.layer.duration());
        let (mut sunk, mut pressure) = (Vec::new(), Vec::new());
        while world.clock().time < end {
            setting.advance(&mut world)?;
            let time = world.clock().time - FILLS;
            let expected = self.layer.sunk(0.5 * self.layer.height, time);
            sunk.push((at_rest - self.middle(&world), expected));
            pressure.push(self.pressure(&world, time)?);
        }
        let at = format!("at K {:.0e}", self.layer.permeability);
        Ok(vec![
            Figure::relative(
                format!("pressure before the push {at}, over the weight of the water"),
                "1",
                1.0,
                mean(before.iter().map(|at_rest| at_rest.0)),
                0.02,
            ),
            Figure::error(
                format!("rows at one height before the push {at}, rms of their deviation"),
                "1",
                mean(before.iter().map(|at_rest| at_rest.1)),
                0.05,
            ),
            Figure::error(
                format!("jump of the pressure between frames {at}, over the largest"),
                "1",
                jump(&pressure),
                0.1,
            ),
            Figure::error(
                format!("way down at half height {at}, L2 over the largest"),
                "1",
                error(&sunk),
                0.03,
            ),
            Figure::error(
                format!("pressure above the floor {at}, L2 over the largest"),
                "1",
                error(&pressure),
                0.05,
            ),
        ])
    }

    fn scene(&self, setting: &Setting) -> Result<Scene, Failure> {
        let (half, top) = (self.half(), self.top());
        let corner = |y: f64| DVec3::new(-half, y, -half).as_vec3();
        let sponge = Sponge {
            edge: self.edge as f32,
            cells: self.cells,
            permeability: (setting.planted(1.0, 3.0) * self.layer.permeability) as f32,
            porosity: POROSITY as f32,
            entry_pressure: 0.0,
            saturation: 1.0,
            friction: 0.0,
            ..Sponge::new("layer", corner(0.0))
        };
        let across = DVec3::new(half, top + ABOVE, half).as_vec3();
        let fluid = Fluid {
            spacing: (0.5 * self.edge) as f32,
            viscosity: self.layer.viscosity as f32,
            blocks: vec![FluidBlock::new(corner(top), across)],
            ..Fluid::default()
        };
        let scene = Scene {
            gravity: Vec3::new(0.0, -GRAVITY as f32, 0.0),
            time: Time { frame_rate: 200.0, ..Time::default() },
            ..Scene::new("vessel")
        }
        .in_box(corner(0.0), across + Vec3::Y * ABOVE as f32)
        .with_fluid(fluid)
        .with_sponge(sponge);
        let scene = self.bars().into_iter().fold(scene, Scene::with_body);
        Ok(MATERIAL.applied(&scene, &setting.solvers)?)
    }

    /// Thin bars that hold the topmost nodes and let water pass.
    fn bars(&self) -> Vec<Body> {
        let (half, thickness) = (self.half(), 0.05 * self.edge);
        let shape = ShapeKind::Cuboid { half_extents: DVec3::new(half, thickness, thickness).as_vec3() };
        let start = FILLS as f32;
        let push = Motion::Linear {
            velocity: Vec3::NEG_Y * self.layer.speed as f32,
            start,
            end: start + self.layer.moves as f32,
            ease: 0.0,
        };
        (0..=self.cells.z)
            .map(|index| {
                let place = DVec3::new(0.0, self.top(), f64::from(index) * self.edge - half).as_vec3();
                let bar = Body::kinematic(&format!("bar{index}"), shape.clone(), place, vec![push]);
                Body { grip: true, ..bar }
            })
            .collect()
    }

    /// Mean height of the nodes about half the height of the sponge \[m\].
    fn middle(&self, world: &World) -> f64 {
        let (rest, half) = (&world.lattice().position, 0.5 * self.top());
        let nodes = rest.iter().zip(world.node_positions());
        let near = nodes.filter(|(rest, _)| (f64::from(rest[1]) - half).abs() < 0.6 * self.edge);
        mean(near.map(|(_, now)| f64::from(now[1])))
    }

    /// Pressure of the water in the second layer of cells, over that of its weight: the mean, and the root mean square of the deviations
    /// of the rows at one height from it, those along the walls among them.
    fn at_rest(&self, world: &World) -> Result<(f64, f64), Failure> {
        let level = surface(world, self.half() - self.edge)?;
        // A row is the particles at one height in a square of an edge.
        let mut rows = BTreeMap::<[i32; 3], Vec<f64>>::new();
        for (row, pressure) in world.particle_positions().iter().zip(world.particle_pressures()) {
            let [x, y, z] = [0, 1, 2].map(|axis| f64::from(row[axis]));
            if (self.edge..2.0 * self.edge).contains(&y) {
                let place = [x, 2.0 * y, z].map(|x| (x / self.edge).floor() as i32);
                let share = POROSITY * f64::from(pressure) / (WATER * GRAVITY * (level - y));
                rows.entry(place).or_default().push(share);
            }
        }
        let means: Vec<f64> = rows.into_values().map(mean).collect();
        let all = mean(means.iter().copied());
        Ok((all, root_mean_square(means.iter().map(|row| row - all))))
    }

    /// Pressure of the water above that of its own weight, mean over the second layer of cells away from the walls, and the
    /// reference \[Pa\].
    ///
    /// The pressure of the solver is that of a unit of volume of water and material together, and the material bears its
    /// share.
    fn pressure(&self, world: &World, time: f64) -> Result<(f64, f64), Failure> {
        let level = surface(world, self.half() - self.edge)?;
        let inner = self.half() - self.edge;
        let (mut measured, mut expected) = (Vec::new(), Vec::new());
        for (row, pressure) in world.particle_positions().iter().zip(world.particle_pressures()) {
            let [x, y, z] = [0, 1, 2].map(|axis| f64::from(row[axis]));
            if x.abs() < inner && z.abs() < inner && (self.edge..2.0 * self.edge).contains(&y) {
                measured.push(POROSITY * f64::from(pressure) - WATER * GRAVITY * (level - y));
                expected.push(self.layer.pressure(y, time));
            }
        }
        Ok((mean(measured), mean(expected)))
    }
}

/// Largest change of the measured pressure between frames, over the largest reference.
fn jump(curve: &[(f64, f64)]) -> f64 {
    let largest = curve.iter().map(|point| point.1).fold(0.0, f64::max);
    curve.windows(2).map(|pair| (pair[1].0 - pair[0].0).abs()).fold(0.0, f64::max) / largest
}

/// Root mean square of measured less reference, over the largest reference.
fn error(curve: &[(f64, f64)]) -> f64 {
    let largest = curve.iter().map(|point| point.1).fold(0.0, f64::max);
    root_mean_square(curve.iter().map(|(measured, expected)| measured - expected)) / largest
}
