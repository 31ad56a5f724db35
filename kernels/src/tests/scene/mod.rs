//! Random but consistent columns and parameters, without the root package.

mod ingredients;
mod options;
mod step;

use glam::Vec3;

use super::lattice::{Block, Lattice};
use crate::{
    column::{FAR_ROW, padded},
    columns::{Columns, RowCounts, lane},
    contents::Contents,
    cpu::Cpu,
    kernel::Kernel,
    kernel_named,
    lanes::SimdLevel,
    need::Need,
    params::Params,
    pbd::{flatness::flatness, stars::Stars},
    smoothing::Wendland,
    testing::Random,
};
use ingredients::{GRIPPER, bodies, params};

pub(super) use options::{BLOCK, all_options};
pub(crate) use options::{CHANNEL, FULL, Options, TORUS};
use step::continues;
pub(super) use step::orders;

#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) options: Options,
    pub(crate) params: Params,
    pub(crate) columns: Columns,
}

impl Scene {
    pub(crate) fn new(options: Options) -> Self {
        let mut scene = Self { options, params: params(options), columns: Columns::default() };
        let mut random = Random(41);
        scene.add_fluid(&mut random);
        scene.add_sponges(&mut random);
        if options.bodies {
            scene.columns.bodies.states.0 = bodies(options.compound);
        }
        scene.columns.rows.bodies = scene.columns.bodies.states.0.len();
        scene
    }

    /// The scene just before a kernel, in the second step: all columns have their shape. At its second place if it
    /// continues what it began at the first. Sponges are solved in the way that the kernel is for.
    pub(in crate::tests) fn before(&self, name: &str, cpu: &Cpu) -> Self {
        self.before_place(name, cpu, usize::from(continues(name)))
    }

    /// The same at a place of the step where the kernel runs.
    pub(in crate::tests) fn before_place(&self, name: &str, cpu: &Cpu, place: usize) -> Self {
        let mut scene = self.clone();
        for need in kernel_named(name).map_or(&[][..], |kernel| kernel.needs) {
            if let Need::Solver(solver) = need {
                scene.params.sponges.iter_mut().for_each(|sponge| sponge.solve_by(*solver));
            }
        }
        let orders = orders(self.options);
        let order = orders.iter().find(|order| order.contains(&name)).expect("a step has every kernel");
        scene.run(cpu, order);
        let mut places = (0..order.len()).filter(|place| order[*place] == name);
        scene.run(cpu, &order[..places.nth(place).expect("this order has it")]);
        scene
    }

    /// Runs the kernels of a step that have work.
    pub(in crate::tests) fn step(&mut self, cpu: &Cpu) {
        let [order, ..] = orders(self.options);
        self.run(cpu, &order);
    }

    /// Runs kernels that have work.
    pub(in crate::tests) fn run(&mut self, cpu: &Cpu, names: &[&str]) {
        for name in names {
            let kernel = kernel_named(name).expect("a name of the table");
            if self.has_work(kernel) {
                cpu.enter(|| (kernel.cpu)(cpu, &self.params, &mut self.columns));
            }
        }
    }

    /// Whether the scene meets the needs of a kernel.
    pub(in crate::tests) fn has_work(&self, kernel: &Kernel) -> bool {
        let all = Contents::new(&self.params, &self.columns);
        let contents = Contents { touch: all.touch && self.options.touch, ..all };
        kernel.needs.iter().all(|need| need.missing(&contents).is_none())
    }

    fn add_fluid(&mut self, random: &mut Random) {
        let count = self.options.fluid;
        let (n, spacing) = (self.options.refinement(), self.options.spacing());
        let fluid = &mut self.columns.fluid;
        for index in 0..count {
            // A stride through the block, so that few particles are still all over the place.
            let place = index * 389 % (BLOCK * n * n * n);
            let site = [place % (13 * n), place / (13 * n) % (9 * n), place / (117 * n * n)];
            let mut jittered = |site: usize| (site as f32 + 0.5 + 0.2 * (random.unit() - 0.5)) * spacing;
            fluid.position.push([jittered(site[0]), jittered(site[1]), jittered(site[2]), 0.0]);
            let mut speed = || random.unit() - 0.5;
            // The fourth is what compression is allowed, where pressure is solved for.
            let [x, y, z] = [speed(), speed(), speed()];
            fluid.velocity.push([x, y, z, 1.0e-3 * x]);
            // Unique, and in another order than the rows.
            fluid.id.push((count - index) as u32 * 2);
        }
        fluid.position.resize(padded(count), FAR_ROW);
        fluid.velocity.resize(padded(count), [0.0; 4]);
        fluid.id.resize(padded(count), u32::MAX);
        self.columns.rows.fluid = count;
    }

    fn add_sponges(&mut self, random: &mut Random) {
        let blocks = if self.options.sponges { blocks_of(self.options) } else { Vec::new() };
        let lattice = Lattice::new(&blocks, 8);
        let count = lattice.position.len();
        let nodes = &mut self.columns.nodes;
        for node in 0..count {
            let edge = blocks[lattice.sponge[node] as usize].edge;
            let volume = edge.powi(3) / 48.0 * lattice.tets_at[node] as f32;
            let mut jittered = |x: f32| x + 0.06 * edge * (random.unit() - 0.5);
            let [x, y, z] = lattice.position[node].map(&mut jittered);
            nodes.position.push([x, y, z, 1.0 / (60.0 * volume)]);
            let mut speed = || 0.6 * (random.unit() - 0.5);
            // w: a node that something holds, but not all of it.
            nodes.velocity.push([speed(), speed(), speed(), 0.9]);
            nodes.volume.push(volume);
            nodes.suction.push(if lattice.tets_at[node] == 24 { 1.0 } else { 0.0 });
        }
        let rows = padded(count);
        nodes.interior = interior(&self.params, &nodes.position, &nodes.volume);
        nodes.interior.resize(rows, 0.0);
        nodes.position.resize(rows, FAR_ROW);
        nodes.velocity.resize(rows, [0.0; 4]);
        nodes.volume.resize(rows, 0.0);
        nodes.suction.resize(rows, 0.0);
        if self.options.wetting {
            nodes.wetting = (0..rows).map(|_| std::array::from_fn(|_| random.unit())).collect();
        }
        // w: length of the step before.
        let mut driven = Random(31);
        let mut speed = || 0.6 * (driven.unit() - 0.5);
        nodes.driven = (0..rows).map(|_| [speed(), speed(), speed(), 0.002]).collect();
        nodes.sponge = lattice.sponge;
        nodes.sponge.resize(rows, 0);
        nodes.grip = vec![u32::MAX; rows];
        nodes.grip_offset = vec![[0.0; 4]; rows];
        if self.options.bodies {
            let body = &bodies(false)[GRIPPER];
            for node in (0..count).step_by(40) {
                let [x, y, z, _] = nodes.position[node];
                let offset = body.state.rotation.inverse() * (Vec3::new(x, y, z) - body.state.position);
                nodes.position[node][lane::nodes::position::INVERSE_MASS] = 0.0;
                nodes.grip[node] = GRIPPER as u32;
                nodes.grip_offset[node] = [offset.x, offset.y, offset.z, 0.0];
            }
        }
        self.columns.rows =
            RowCounts { nodes: count, tets: lattice.topology.tets.len(), ..self.columns.rows };
        let rest: Vec<[f32; 4]> = lattice.position.iter().map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        nodes.stars = Stars::new(&lattice.topology, &rest, &nodes.sponge);
        let flat = flatness(&lattice.topology.tets, &rest);
        nodes.rest = rest.iter().zip(flat).map(|([x, y, z, _], flat)| [*x, *y, *z, flat]).collect();
        nodes.rest.resize(rows, FAR_ROW);
        nodes.topology = lattice.topology;
    }
}

fn interior(params: &Params, position: &[[f32; 4]], volume: &[f32]) -> Vec<f32> {
    let radius = f64::from(params.coupling.support_radius);
    let weight = |a: &[f32; 4], b: &[f32; 4]| {
        let square: f64 = (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum();
        Wendland::value_f64(radius, square.sqrt())
    };
    let at = |a| position.iter().zip(volume).map(|(b, volume)| f64::from(*volume) * weight(a, b)).sum();
    position.iter().map(|a| -> f64 { at(a) }).map(|sum| sum as f32).collect()
}

pub(super) fn blocks() -> Vec<Block> {
    vec![
        Block { cells: [4, 4, 4], edge: 0.01, origin: [0.01, 0.0, 0.005] },
        Block { cells: [3, 4, 3], edge: 0.008, origin: [0.055, 0.004, 0.01] },
    ]
}

/// The blocks of a scene: where they touch, the second is pressed into the first, and a thin one is close above it.
fn blocks_of(options: Options) -> Vec<Block> {
    let mut blocks = blocks();
    if options.fine {
        blocks[0] = Block { cells: [18; 3], edge: blocks[0].edge / 4.5, ..blocks[0] };
    }
    if options.touch {
        blocks[1].origin[0] = 0.0497;
        blocks.push(Block { cells: [3, 1, 3], edge: 0.01, origin: [0.012, 0.0445, 0.008] });
    }
    blocks
}

/// One thread at the best level.
pub(super) fn best() -> Cpu {
    Cpu::serial(SimdLevel::best()).expect("the best level is there")
}

#[test]
fn every_ingredient_touches_the_others() {
    let mut scene = Scene::new(FULL);
    scene.step(&best());
    let columns = &scene.columns;
    for body in 0..columns.rows.bodies {
        let of = |wrenches: &[crate::body::Wrench]| {
            let own = wrenches.iter().skip(body).step_by(columns.rows.bodies);
            own.fold(0.0, |sum, wrench| sum + wrench.impulse.length())
        };
        assert!(of(&columns.bodies.fluid_wrenches.0) > 0.0, "fluid at body {body}");
        assert!(body == GRIPPER || of(&columns.bodies.node_wrenches.0) > 0.0, "nodes at body {body}");
    }
    assert!(columns.nodes.saturation.iter().any(|saturation| *saturation > 0.3));
    assert!(columns.rows.nodes > crate::cpu::CHUNK && columns.rows.fluid > 4 * crate::cpu::CHUNK);
    for (node, position) in columns.nodes.position[..columns.rows.nodes].iter().enumerate() {
        assert!(position.iter().all(|value| value.is_finite()), "node {node}");
    }
    for (row, position) in columns.fluid.position[..columns.rows.fluid].iter().enumerate() {
        assert!(position.iter().all(|value| value.is_finite()), "particle {row}");
    }
}

#[test]
fn interior_at_rest_is_the_sum_over_all_nodes() {
    let scene = Scene::new(FULL);
    let found = crate::couple::interior::node_interior(&best(), &scene.params, &scene.columns);
    for (node, (found, expected)) in found.iter().zip(&scene.columns.nodes.interior).enumerate() {
        assert!((found - expected).abs() < 1e-6, "node {node}: {found} instead of {expected}");
    }
    assert!(scene.columns.nodes.interior.iter().any(|value| *value > 0.9));
}
