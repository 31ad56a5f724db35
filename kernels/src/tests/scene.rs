//! Random but consistent columns and parameters, without the root package.

use glam::{EulerRot, Quat, Vec3};

use super::lattice::{Block, Lattice};
use crate::{
    KERNELS,
    body::{Body, BodyKind, BodyState, Shape},
    column::{FAR_ROW, padded},
    columns::{Column, Columns, RowCounts, lane},
    contents::Contents,
    cpu::Cpu,
    grid::cells::Domain,
    kernel::Kernel,
    kernel_named,
    lanes::SimdLevel,
    need::Need,
    params::{
        Cohesion, EquationOfState, FluidParams, ImplicitViscosity, Incompressible, NO_WALL, Params, Solver,
        SpongeParams, WettingParams,
    },
    pbd::{flatness::flatness, stars::Stars},
    periodic::Periodic,
    smoothing::Wendland,
    sph::{factors::lattice_diagonal, obstacles::boundary_profile},
    testing::Random,
};

const SPACING: f32 = 0.005;
/// Particles of the whole block: 13 x 9 x 9.
pub(super) const BLOCK: usize = 1053;

/// The kernels in the order of a step, each at least once.
pub(super) const CHAIN: &[&str] = &[
    "grid::sort_fluid",
    "grid::fluid_neighbors",
    "sph::density",
    "sph::pressure",
    "couple::controls",
    "pbd::pairs",
    "couple::saturation",
    "couple::wetting",
    "couple::pores",
    "couple::interior",
    "pbd::gravity",
    "couple::zero_distance",
    "sph::forces",
    "sph::surface_tension",
    "sph::deficit",
    "sph::cohesion",
    "sph::repulsion",
    "sph::boundary_pressure",
    "sph::wall_friction",
    "couple::suction",
    "couple::solid_pressure",
    "sph::kick",
    "sph::viscosity_begin",
    "sph::viscosity_product",
    "sph::viscosity_update",
    "sph::viscosity_product",
    "sph::viscosity_update",
    "sph::viscosity_reaction",
    "sph::viscosity_kick",
    "sph::predict",
    "sph::boundary",
    "couple::solid_share",
    "sph::factors",
    "sph::pressure_update",
    "sph::pressure_acceleration",
    "couple::solid_yield",
    "sph::pressure_residual",
    "sph::pressure_update",
    "sph::pressure_acceleration",
    "couple::solid_yield",
    "sph::pressure_residual",
    "couple::solid_reaction",
    "sph::pressure_kick",
    "sph::boundary_reaction",
    "sph::position_correction",
    "pbd::predict",
    "pbd::guess",
    "couple::node_velocity",
    "couple::drag_impulse",
    "couple::drag_target",
    "couple::drag_reaction",
    "pbd::strain",
    "pbd::xpbd_neo_hookean",
    "pbd::touch",
    "pbd::vbd",
    "pbd::contact",
    "pbd::touch",
    "pbd::reaction",
    "pbd::momentum",
    "couple::drag_settled",
    "couple::drag_kick",
    "pbd::velocity",
    "couple::control_velocity",
    "couple::drag",
    "couple::velocity_filter",
    "couple::drag",
    "couple::exchange",
    "sph::sweep",
    "sph::advect",
];

/// What a scene contains.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    /// Particles; beyond [`BLOCK`] they are closer together.
    pub(crate) fluid: usize,
    pub(crate) sponges: bool,
    pub(crate) bodies: bool,
    pub(crate) walls: bool,
    pub(crate) bounded: bool,
    pub(crate) equation_of_state: EquationOfState,
    pub(crate) incompressible: bool,
    pub(crate) porous: bool,
    pub(crate) cohesion: bool,
    /// Whether properties depend on how wet sponges are, where a kernel asks.
    pub(crate) wetting: bool,
    pub(crate) implicit_viscosity: bool,
    /// Axes on which space repeats, by the length of the block; for scenes without sponges.
    pub(crate) periodic: [bool; 3],
    /// Whether sponges touch each other, where a kernel asks.
    pub(crate) touch: bool,
}

/// Everything at once: all ingredients touch each other.
pub(crate) const FULL: Options = Options {
    fluid: BLOCK,
    sponges: true,
    bodies: true,
    walls: true,
    bounded: true,
    equation_of_state: EquationOfState::Tait,
    incompressible: false,
    porous: false,
    cohesion: false,
    wetting: false,
    implicit_viscosity: false,
    periodic: [false; 3],
    touch: false,
};

/// What repeats along two axes, as a channel does, and along all of them.
pub(crate) const CHANNEL: Options = Options { sponges: false, periodic: [true, false, true], ..FULL };
pub(crate) const TORUS: Options = Options {
    fluid: 1000,
    bodies: false,
    walls: false,
    bounded: false,
    sponges: false,
    periodic: [true; 3],
    ..FULL
};

impl Options {
    /// The same, with the pressure that the kernel is there for.
    pub(super) fn suiting(self, kernel: &Kernel) -> Self {
        // What fluid does to vertex block descent, it does with sponges as porous media.
        let of_fluid = |column: &Column| {
            matches!(column, Column::NodeFree | Column::NodeTarget | Column::FluidSolidYield)
        };
        let touched = || kernel.reads.iter().chain(kernel.writes).any(of_fluid);
        let porous = kernel.needs.contains(&Need::Porous) || touched();
        // Walls and bodies are part of the surface where pressure is solved for.
        let solves = [Need::Incompressible, Need::Cohesion, Need::NoSlip]
            .iter()
            .any(|need| kernel.needs.contains(need));
        let cohesion = kernel.needs.contains(&Need::Cohesion);
        let reads = kernel.reads.contains(&Column::NodeWetting);
        let wetting = self.wetting && (reads || porous) || kernel.needs.contains(&Need::Wetting);
        let porous = porous || wetting;
        let implicit_viscosity = kernel.needs.contains(&Need::ImplicitViscosity);
        let of_touch = |column: &Column| matches!(column, Column::NodeTouch | Column::NodePairs);
        let touch = kernel.reads.iter().chain(kernel.writes).any(of_touch);
        Self {
            incompressible: porous || solves,
            porous,
            cohesion,
            implicit_viscosity,
            wetting,
            touch,
            ..self
        }
    }

    /// Sites per site of the coarse block, along each axis.
    fn refinement(self) -> usize {
        (1..).find(|n| BLOCK * n * n * n >= self.fluid).unwrap_or(1)
    }

    fn spacing(self) -> f32 {
        SPACING / self.refinement() as f32
    }
}

impl SpongeParams {
    /// Constraints of a material are only solved in steps that are short for it (`src/clock.rs`). Beyond, a sweep turns
    /// every other tet inside out, and what was rounded away grows by a hundred: the material is softer then.
    fn solve_by(&mut self, solver: Solver) {
        self.solver = solver;
        if solver == Solver::XpbdNeoHookean {
            (self.mu, self.lambda) = (self.mu * 0.02, self.lambda * 0.02);
        }
    }
}

/// Sizes around the width of a vector, and scenes that lack something.
pub(super) fn all_options() -> Vec<Options> {
    let mut all = vec![
        FULL,
        Options { bodies: false, bounded: false, equation_of_state: EquationOfState::Linear, ..FULL },
        // A multiple of eight: the last group of eight rows is all padding.
        Options { fluid: 1000, walls: false, bounded: false, ..FULL },
        Options { walls: false, bodies: false, ..FULL },
        Options { sponges: false, ..FULL },
        Options { wetting: true, ..FULL },
        CHANNEL,
        Options { bounded: false, walls: false, equation_of_state: EquationOfState::Linear, ..CHANNEL },
        TORUS,
    ];
    let few = [0, 1, 7, 8, 9].map(|fluid| Options { fluid, ..FULL });
    all.extend(few);
    all.extend(few.map(|few| Options { sponges: false, bodies: false, ..few }));
    all
}

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
            scene.columns.bodies.states.0 = bodies();
        }
        scene.columns.rows.bodies = scene.columns.bodies.states.0.len();
        scene
    }

    /// The scene just before the last run of a kernel, in the second step: all columns have their shape. Sponges are
    /// solved in the way that the kernel is for.
    pub(super) fn before(&self, name: &str, cpu: &Cpu) -> Self {
        let mut scene = self.clone();
        for need in kernel_named(name).map_or(&[][..], |kernel| kernel.needs) {
            if let Need::Solver(solver) = need {
                scene.params.sponges.iter_mut().for_each(|sponge| sponge.solve_by(*solver));
            }
        }
        scene.run(cpu, CHAIN);
        let end = CHAIN.iter().rposition(|other| *other == name).expect("the chain has every kernel");
        scene.run(cpu, &CHAIN[..end]);
        scene
    }

    /// Runs kernels that have work.
    pub(super) fn run(&mut self, cpu: &Cpu, names: &[&str]) {
        for name in names {
            let kernel = kernel_named(name).expect("the chain names kernels");
            if self.has_work(kernel) {
                cpu.enter(|| (kernel.cpu)(cpu, &self.params, &mut self.columns));
            }
        }
    }

    /// Whether the scene meets the needs of a kernel.
    pub(super) fn has_work(&self, kernel: &Kernel) -> bool {
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
        nodes.sponge = lattice.sponge;
        nodes.sponge.resize(rows, 0);
        nodes.grip = vec![u32::MAX; rows];
        nodes.grip_offset = vec![[0.0; 4]; rows];
        if self.options.bodies {
            let body = &bodies()[GRIPPER];
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

/// The body that holds nodes.
const GRIPPER: usize = 5;

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
    if options.touch {
        blocks[1].origin[0] = 0.0497;
        blocks.push(Block { cells: [3, 1, 3], edge: 0.01, origin: [0.012, 0.0445, 0.008] });
    }
    blocks
}

fn params(options: Options) -> Params {
    let spacing = options.spacing();
    let radius = 2.2 * spacing;
    // A power of a constant is rounded once, and the oracles' bounds are for that mass.
    let cube = if options.refinement() == 1 { SPACING.powi(3) } else { spacing.powi(3) };
    let sum = Wendland::lattice_sum(f64::from(radius), f64::from(spacing)) as f32;
    let (low, high) = (Vec3::new(-0.002, 0.0024, -0.001), Vec3::new(0.0775, 0.06, 0.05));
    let domain = Domain::Bounded { minimum: low - 0.02, maximum: high + 0.02 };
    let without = |corner: Vec3, far: f32| Vec3::select(options.periodic.into(), Vec3::splat(far), corner);
    Params {
        // As far over the spacing in a step: faster ones would be thrown many boxes far, and the way back in is rounded.
        step: 0.001 / options.refinement() as f32,
        asleep: crate::asleep::Asleep::default(),
        gravity: Vec3::new(0.5, -9.81, 0.25),
        domain: if options.bounded { domain } else { Domain::Unbounded },
        walls: options.walls.then_some((without(low, -NO_WALL), without(high, NO_WALL))),
        periodic: Periodic::new(Vec3::ZERO, Vec3::new(13.0, 9.0, 9.0) * SPACING, options.periodic),
        no_slip: true,
        fluid: FluidParams {
            spacing,
            rest_density: 1000.0,
            particle_mass: 1000.0 * cube / sum,
            smoothing: Wendland::new(radius),
            equation_of_state: options.equation_of_state,
            sound_speed: 10.0,
            incompressible: options.incompressible.then(|| incompressible(radius, spacing)),
            viscosity: 0.5,
            central_viscosity: 0.3,
            implicit_viscosity: options.implicit_viscosity.then_some(IMPLICIT_VISCOSITY),
            roughness: if options.incompressible { 5.0e-7 } else { 0.0 },
            wall_viscosity: 5.0,
            // The colour field knows volumes that change.
            surface_tension: if options.incompressible { 0.0 } else { 0.07 },
            cohesion: options.cohesion.then(|| cohesion(radius, spacing)),
            repulsion_range: spacing,
            repulsion_stiffness: 1.0e5,
            repulsion_damping: 50.0,
        },
        sponges: if options.sponges { sponges(options.wetting, options.touch) } else { Vec::new() },
        coupling: Wendland::new(0.015),
        solid: options.porous.then(|| Wendland::new(0.012)),
    }
}

/// With a tolerance that the first round meets, so that rounding does not decide about the residual.
const IMPLICIT_VISCOSITY: ImplicitViscosity =
    ImplicitViscosity { viscosity: 8.0, central_viscosity: 5.0, tolerance: 1.0e6, rounds: 50 };

/// With a tolerance of zero, so that rounding does not decide about one more round.
fn incompressible(radius: f32, spacing: f32) -> Incompressible {
    let smoothing = Wendland::new(radius);
    let (boundary_range, boundary_share) = boundary_profile(&smoothing, spacing);
    Incompressible {
        projections: None,
        tolerance: 0.0,
        rounds: 50,
        lattice_diagonal: lattice_diagonal(&smoothing, spacing),
        correction_speed: 1.0,
        boundary_range,
        boundary_share,
    }
}

fn cohesion(radius: f32, spacing: f32) -> Cohesion {
    let smoothing = Wendland::new(1.5 * radius);
    let (boundary_range, boundary_share) = boundary_profile(&smoothing, spacing);
    let sum = Wendland::lattice_sum(1.5 * f64::from(radius), f64::from(spacing)) as f32;
    Cohesion { stiffness: 500.0, smoothing, volume: spacing.powi(3) / sum, boundary_range, boundary_share }
}

fn sponges(has_wetting: bool, touch: bool) -> Vec<SpongeParams> {
    let mut wetting = [WettingParams::default(), WettingParams::default()];
    if has_wetting {
        wetting[0] =
            WettingParams { softening: 0.6, swelling: 0.03, time: 0.004, exponent: 4, receding: 250.0 };
        wetting[1].receding = 100.0;
    }
    let [of_soft, of_stiff] = wetting;
    let soft = SpongeParams {
        edge: 0.01,
        solver: Solver::Sbd,
        mu: 8.0e3,
        lambda: 1.3e4,
        damping: 0.002,
        stretch_modulus: 8.0e3,
        shear_modulus: 4.0e3,
        volume_modulus: 2.0e3,
        damping_time: 0.002,
        iterations: 4,
        friction: 0.4,
        self_contact: false,
        porosity: 0.9,
        drag_rate: 2000.0,
        inertial_drag: 300.0,
        pores_close: true,
        entry_pressure: 300.0,
        saturation_gain: 1.5,
        reaction: 1.0,
        wetting: of_soft,
    };
    let stiff = SpongeParams {
        edge: 0.008,
        solver: Solver::Sbd,
        mu: 2.0e4,
        lambda: 3.0e4,
        damping: 0.0,
        stretch_modulus: 3.0e4,
        shear_modulus: 2.0e4,
        volume_modulus: 1.0e4,
        damping_time: 0.0,
        iterations: 2,
        friction: 0.1,
        self_contact: false,
        porosity: 0.8,
        drag_rate: 500.0,
        inertial_drag: 0.0,
        pores_close: false,
        entry_pressure: 150.0,
        saturation_gain: 0.5,
        reaction: 0.7,
        wetting: of_stiff,
    };
    let mut all = vec![soft, stiff];
    if touch {
        all.push(SpongeParams { self_contact: true, ..all[0].clone() });
    }
    all
}

/// One body of every shape, each touching fluid and nodes, and one that grips.
fn bodies() -> Vec<Body> {
    let corner = 0.006_f32;
    let signs = [-1.0_f32, 1.0];
    let faces = signs.map(|x| signs.map(|y| signs.map(|z| (Vec3::new(x, y, z).normalize(), corner))));
    let hull = Shape::Hull {
        planes: faces.into_iter().flatten().flatten().collect(),
        vertices: [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .flat_map(|axis| signs.map(|sign| axis * sign * corner * 3.0_f32.sqrt()))
            .collect(),
        triangles: Vec::new(),
    };
    let half_extents = Vec3::new(0.006, 0.004, 0.008);
    let capsule = Shape::Capsule { half_height: 0.01, radius: 0.004 };
    let mut all = vec![
        body(Shape::Sphere { radius: 0.008 }, [0.03, 0.02, 0.02], 0.0),
        body(Shape::Cuboid { half_extents }, [0.06, 0.03, 0.03], 0.7),
        body(capsule, [0.0162, 0.035, 0.03], -0.4),
        body(hull, [0.045, 0.012, 0.035], 0.3),
        // The solid side is +x, where padding rows lie as well.
        body(Shape::Plane, [0.066, 0.0, 0.0], 1.62),
        body(Shape::Sphere { radius: 0.01 }, [0.03, 0.05, 0.02], 0.9),
    ];
    all[4].kind = BodyKind::Kinematic;
    all[GRIPPER].touches_nodes = false;
    all[1].no_slip = false;
    // Faster than contact and pressure are made for.
    all[1].state.linear_velocity = Vec3::new(2.0, -1.0, 1.5);
    all
}

fn body(shape: Shape, position: [f32; 3], angle: f32) -> Body {
    let position = Vec3::from_array(position);
    Body {
        shape,
        kind: BodyKind::Dynamic,
        state: BodyState {
            position,
            rotation: Quat::from_euler(EulerRot::ZXY, angle, angle * 0.3, angle * 0.1),
            linear_velocity: Vec3::new(0.1, -0.3, 0.2) - position,
            angular_velocity: Vec3::new(3.0, -2.0, 1.0),
        },
        friction: 0.3,
        touches_nodes: true,
        no_slip: true,
    }
}

/// One thread at the best level.
pub(super) fn best() -> Cpu {
    Cpu::serial(SimdLevel::best()).expect("the best level is there")
}

#[test]
fn the_chain_has_every_kernel() {
    for kernel in KERNELS {
        assert!(CHAIN.contains(&kernel.name), "{}", kernel.name);
    }
}

#[test]
fn every_ingredient_touches_the_others() {
    let mut scene = Scene::new(FULL);
    scene.run(&best(), CHAIN);
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
