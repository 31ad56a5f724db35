//! From a scene to columns: seeds the water, fills the lattices, places the bodies.

use glam::{Quat, Vec3};
use sorb_kernels::{
    body::{Bodies, Body},
    columns::{Columns, FAR_ROW, RowCounts, padded},
    couple::interior::node_interior,
    cpu::Cpu,
    grid::cells::Domain,
    params::{Cohesion, EquationOfState, FluidParams, Incompressible, Params, Solver, SpongeParams},
    pbd::{
        lattice::{TetChunk, Topology},
        stars::Stars,
    },
    smoothing::Wendland,
    sph::{boundary::boundary_profile, deficit::cohesion_stiffness, factors::lattice_diagonal},
};

use crate::{
    rigid::{BodySetup, RigidEngine},
    scene::{self, Scene},
    sponge::{self, Lattice, LatticeSponge, SLOT_VERTEX_COLOR},
    world::WorldError,
};

/// Tets of a chunk that one thread solves at a time.
const TETS_PER_CHUNK: usize = 256;
/// Displacement of seeded particles over the spacing: a perfect lattice hides errors of order.
const JITTER: f32 = 0.01;
/// Distance from a body, over the spacing, at which no particle is seeded.
const CLEARANCE: f32 = 0.4;

/// Everything that a world is made of at time zero.
pub(crate) struct Setup {
    pub(crate) params: Params,
    pub(crate) columns: Columns,
    pub(crate) lattice: Lattice,
    pub(crate) engine: Box<dyn RigidEngine>,
}

impl Setup {
    pub(crate) fn new(scene: &Scene, cpu: &Cpu) -> Result<Self, WorldError> {
        let params = params(scene);
        let mut columns = Columns::default();
        let setups = scene.bodies.iter().map(body_setup).collect::<Result<Vec<_>, _>>()?;
        let engine = engine(scene, &setups)?;
        place_bodies(scene, &setups, &*engine, &mut columns);
        let lattice = lattice(scene)?;
        fill_nodes(scene, &params, &lattice, &mut columns);
        if scene.fluid.is_some() && !scene.sponges.is_empty() {
            columns.nodes.interior = cpu.enter(|| node_interior(cpu, &params, &columns));
        }
        seed_fluid(scene, &params, &mut columns);
        Ok(Self { params, columns, lattice, engine })
    }
}

fn params(scene: &Scene) -> Params {
    let (domain, walls) = match scene.domain {
        scene::Domain::Box { minimum, maximum } => {
            (Domain::Bounded { minimum, maximum }, Some((minimum, maximum)))
        }
        scene::Domain::Open => (Domain::Unbounded, None),
    };
    let radius = scene.sponges.iter().map(|sponge| sponge.suction_radius * sponge.edge).fold(0.0, f32::max);
    Params {
        step: scene.time.maximum_step,
        gravity: scene.gravity,
        domain,
        walls,
        no_slip: scene.fluid.as_ref().is_some_and(|fluid| fluid.no_slip),
        fluid: fluid_params(scene),
        sponges: scene.sponges.iter().map(|sponge| sponge_params(scene, sponge)).collect(),
        coupling: Wendland::new(if radius > 0.0 { radius } else { 1.0 }),
        solid: solid(scene),
    }
}

/// Support radius of the volume of the material, over the edge of a cell: the least at which the nodes blend into one
/// body (between them its share is 0.96 to 1.17 of the mean). A smaller one makes wells, a larger one blurs the faces.
const SOLID_RADIUS: f32 = 1.2;

fn solid(scene: &Scene) -> Option<Wendland> {
    let edge = scene.sponges.iter().map(|sponge| sponge.edge).fold(0.0, f32::max);
    let is_porous = edge > 0.0 && scene.coupling() == scene::Coupling::Porous;
    is_porous.then(|| Wendland::new(SOLID_RADIUS * edge))
}

/// Support radius of the energy of the surface over that of the fluid: with as few neighbours as the pressure has, particles at the
/// surface find places where they lack nothing, in rows, and the tension is a tenth of what it should be.
const COHESION_SUPPORT: f32 = 2.0;

/// Compression that is allowed for the roughness of the pressure, over the square of the time that sound takes for a
/// spacing: enough that particles in rows do not have pressures that are higher and lower by turns.
const ROUGHNESS: f32 = 2.0;

fn fluid_params(scene: &Scene) -> FluidParams {
    let Some(fluid) = &scene.fluid else {
        return FluidParams {
            spacing: 1.0,
            rest_density: 1.0,
            particle_mass: 0.0,
            smoothing: Wendland::new(1.0),
            equation_of_state: EquationOfState::Linear,
            sound_speed: 1.0,
            incompressible: None,
            viscosity: 0.0,
            central_viscosity: 0.0,
            roughness: 0.0,
            wall_viscosity: 0.0,
            surface_tension: 0.0,
            cohesion: None,
            repulsion_range: 0.0,
            repulsion_stiffness: 0.0,
            repulsion_damping: 0.0,
        };
    };
    let support = fluid.support_radius();
    let lattice_sum = Wendland::lattice_sum(f64::from(support), f64::from(fluid.spacing));
    let mass = f64::from(fluid.rest_density) * f64::from(fluid.spacing).powi(3) / lattice_sum;
    let sound_speed = fluid.sound_speed.unwrap_or_else(|| scene.default_sound_speed());
    // Monaghan's alpha as a kinematic viscosity in three dimensions, alpha c h / 10 with the smoothing length
    // h = H / 2 [M05, eq. 8.8].
    let numerical = fluid.rest_density * fluid.artificial_viscosity * sound_speed * support / 20.0;
    let is_incompressible = fluid.solver != scene::FluidSolver::Wcsph;
    let (viscosity, central_viscosity) = match (is_incompressible, fluid.viscosity_form) {
        (_, scene::ViscosityForm::Monaghan) => (0.0, fluid.viscosity + numerical),
        (true, scene::ViscosityForm::Morris) => (fluid.viscosity, numerical),
        // As the paper has it.
        (false, scene::ViscosityForm::Morris) => (fluid.viscosity + numerical, 0.0),
    };
    // Half a spacing, where the first layer of a lattice lies. A particle at half the speed of sound is stopped
    // at the surface.
    let range = 0.5 * fluid.spacing;
    let frequency = 0.5 * sound_speed / range;
    FluidParams {
        spacing: fluid.spacing,
        rest_density: fluid.rest_density,
        particle_mass: mass as f32,
        smoothing: Wendland::new(support),
        equation_of_state: match fluid.equation_of_state {
            scene::EquationOfState::Tait => EquationOfState::Tait,
            scene::EquationOfState::Linear => EquationOfState::Linear,
        },
        sound_speed,
        incompressible: incompressible(fluid, &Wendland::new(support), sound_speed),
        viscosity,
        central_viscosity,
        roughness: if is_incompressible { ROUGHNESS * (fluid.spacing / sound_speed).powi(2) } else { 0.0 },
        wall_viscosity: fluid.viscosity,
        surface_tension: if is_incompressible { 0.0 } else { fluid.surface_tension },
        cohesion: cohesion(fluid).filter(|_| is_incompressible),
        repulsion_range: range,
        repulsion_stiffness: frequency * frequency,
        repulsion_damping: 2.0 * fluid.repulsion_damping * frequency,
    }
}

/// Surface tension from an energy of the surface, if there is any.
fn cohesion(fluid: &scene::Fluid) -> Option<Cohesion> {
    let (spacing, smoothing) = (fluid.spacing, Wendland::new(COHESION_SUPPORT * fluid.support_radius()));
    let sum = Wendland::lattice_sum(f64::from(smoothing.support_radius), f64::from(spacing));
    let (boundary_range, boundary_share) = boundary_profile(&smoothing, spacing);
    (fluid.surface_tension > 0.0).then(|| Cohesion {
        stiffness: cohesion_stiffness(&smoothing, spacing, fluid.surface_tension),
        smoothing,
        volume: (f64::from(spacing).powi(3) / sum) as f32,
        boundary_range,
        boundary_share,
    })
}

fn incompressible(fluid: &scene::Fluid, smoothing: &Wendland, sound_speed: f32) -> Option<Incompressible> {
    if fluid.solver == scene::FluidSolver::Wcsph {
        return None;
    }
    let (boundary_range, boundary_share) = boundary_profile(smoothing, fluid.spacing);
    Some(Incompressible {
        tolerance: fluid.density_tolerance,
        rounds: fluid.rounds,
        lattice_diagonal: lattice_diagonal(smoothing, fluid.spacing),
        // The speed of sound is ten times what the fastest water is expected to reach.
        correction_speed: 0.1 * sound_speed,
        boundary_range,
        boundary_share,
    })
}

fn sponge_params(scene: &Scene, sponge: &scene::Sponge) -> SpongeParams {
    let (viscosity, density) =
        scene.fluid.as_ref().map_or((0.0, 1.0), |fluid| (fluid.viscosity, fluid.rest_density));
    let (mu, lambda) = SpongeParams::neo_hookean(sponge.young_modulus, sponge.poisson_ratio);
    SpongeParams {
        edge: sponge.edge,
        solver: match sponge.solver {
            scene::Solver::Sbd => Solver::Sbd,
            scene::Solver::Vbd => Solver::Vbd,
            scene::Solver::XpbdNeoHookean => Solver::XpbdNeoHookean,
        },
        mu,
        lambda,
        damping: sponge.damping,
        stretch_modulus: sponge.stretch_modulus,
        shear_modulus: sponge.shear_modulus,
        volume_modulus: sponge.volume_modulus,
        damping_time: sponge.damping_time,
        iterations: match sponge.solver {
            scene::Solver::XpbdNeoHookean => 1,
            _ => sponge.iterations,
        },
        friction: sponge.friction,
        porosity: sponge.porosity,
        drag_rate: viscosity * sponge.porosity / (density * sponge.permeability),
        inertial_drag: sponge.forchheimer * sponge.porosity * sponge.porosity / sponge.permeability.sqrt(),
        pores_close: scene.coupling() == scene::Coupling::Porous,
        entry_pressure: sponge.entry_pressure,
        saturation_gain: sponge.saturation_gain,
        reaction: sponge.reaction,
    }
}

fn body_setup(body: &scene::Body) -> Result<BodySetup, WorldError> {
    let mut setup = BodySetup {
        name: body.name.clone(),
        shape: sorb_kernels::body::Shape::Plane,
        kind: body.kind,
        density: body.density,
        state: body.start(),
        friction: body.friction,
        restitution: body.restitution,
        motions: body.motions.clone(),
    };
    match &body.shape {
        #[cfg(feature = "rigid")]
        scene::ShapeKind::Hull { vertices } => {
            let hull = crate::rigid::convex_hull(vertices)
                .map_err(|error| WorldError::Hull { body: body.name.clone(), source: error })?;
            setup.shape = hull.shape;
            setup.state.position += setup.state.rotation * hull.offset;
        }
        shape => match shape.primitive() {
            Some(shape) => setup.shape = shape,
            None => {
                return Err(WorldError::NeedsRigid { body: body.name.clone() });
            }
        },
    }
    Ok(setup)
}

fn engine(scene: &Scene, setups: &[BodySetup]) -> Result<Box<dyn RigidEngine>, WorldError> {
    #[cfg(feature = "rigid")]
    if setups.iter().any(|setup| setup.kind == sorb_kernels::body::BodyKind::Dynamic) {
        let container = match scene.domain {
            scene::Domain::Box { minimum, maximum } => Some((minimum, maximum)),
            scene::Domain::Open => None,
        };
        return Ok(Box::new(crate::rigid::RapierEngine::new(scene.gravity, container, setups)?));
    }
    let _ = scene;
    Ok(Box::new(crate::rigid::ScriptedEngine::new(setups)?))
}

fn place_bodies(scene: &Scene, setups: &[BodySetup], engine: &dyn RigidEngine, columns: &mut Columns) {
    let bodies = setups.iter().zip(&scene.bodies).enumerate().map(|(index, (setup, body))| Body {
        shape: setup.shape.clone(),
        kind: setup.kind,
        state: engine.state(index),
        friction: body.friction,
        touches_nodes: !body.grip,
        no_slip: body.no_slip,
    });
    columns.bodies.states = Bodies(bodies.collect());
    columns.rows.bodies = setups.len();
}

fn mask(shape: scene::SpongeShape) -> Box<dyn Fn(Vec3) -> bool> {
    match shape {
        scene::SpongeShape::Block => Box::new(sponge::block),
        scene::SpongeShape::Ellipsoid => Box::new(sponge::ellipsoid),
        scene::SpongeShape::Cylinder { axis } => Box::new(sponge::cylinder(axis)),
    }
}

fn lattice(scene: &Scene) -> Result<Lattice, WorldError> {
    let masks: Vec<_> = scene.sponges.iter().map(|sponge| mask(sponge.shape)).collect();
    let sponges: Vec<_> = scene
        .sponges
        .iter()
        .zip(&masks)
        .map(|(sponge, mask)| LatticeSponge {
            edge: sponge.edge,
            cells: sponge.cells.to_array(),
            origin: sponge.position,
            keep: &**mask,
        })
        .collect();
    Ok(Lattice::new(&sponges)?)
}

fn fill_nodes(scene: &Scene, params: &Params, lattice: &Lattice, columns: &mut Columns) {
    let count = lattice.node_count();
    columns.rows = RowCounts { nodes: count, tets: lattice.tet_count(), ..columns.rows };
    if count == 0 {
        return;
    }
    let rows = padded(count);
    let nodes = &mut columns.nodes;
    nodes.position.clone_from(&lattice.position);
    nodes.volume.clone_from(&lattice.node_volume);
    nodes.sponge.clone_from(&lattice.node_sponge);
    nodes.suction = suction(scene, params, lattice);
    nodes.velocity = lattice
        .node_sponge
        .iter()
        .map(|sponge| {
            let [x, y, z] = scene.sponges[*sponge as usize].velocity.to_array();
            [x, y, z, 0.0]
        })
        .collect();
    nodes.grip = vec![u32::MAX; rows];
    nodes.grip_offset = vec![[0.0; 4]; rows];
    for node in 0..count {
        let sponge = &scene.sponges[lattice.node_sponge[node] as usize];
        let [x, y, z, _] = lattice.position[node];
        let point = Vec3::new(x, y, z);
        let grips = |body: &Body| !body.touches_nodes && body.distance(point) <= 0.0;
        match columns.bodies.states.0.iter().position(grips) {
            Some(body) => {
                let state = &columns.bodies.states.0[body].state;
                let inverse: Quat = state.rotation.conjugate();
                let offset = inverse * (point - state.position);
                nodes.grip[node] = body as u32;
                nodes.grip_offset[node] = [offset.x, offset.y, offset.z, 0.0];
                nodes.position[node][3] = 0.0;
            }
            None => nodes.position[node][3] = 1.0 / (sponge.density * lattice.node_volume[node]),
        }
    }
    nodes.position.resize(rows, FAR_ROW);
    nodes.velocity.resize(rows, [0.0; 4]);
    nodes.topology = topology(lattice);
    nodes.stars = Stars::new(&nodes.topology, &lattice.position, &lattice.node_sponge);
    debug_assert_eq!(params.sponges.len(), scene.sponges.len());
}

/// Whether nodes suck: 1 or 0. Those of the surface do not, so that no coat of water forms around the sponge; as porous
/// media only those of the outermost layer, which have at most half the volume of a node inside.
fn suction(scene: &Scene, params: &Params, lattice: &Lattice) -> Vec<f32> {
    let sucks = |node: usize| {
        if params.solid.is_none() {
            return !lattice.node_surface[node];
        }
        let edge = scene.sponges[lattice.node_sponge[node] as usize].edge;
        // A cell has two nodes.
        lattice.node_volume[node] > 0.51 * 0.5 * edge.powi(3)
    };
    (0..lattice.node_count()).map(|node| if sucks(node) { 1.0 } else { 0.0 }).collect()
}

fn topology(lattice: &Lattice) -> Topology {
    let chunks = sponge::chunks(lattice, TETS_PER_CHUNK).map(|chunks| {
        chunks
            .into_iter()
            .map(|chunk| TetChunk { tets: chunk.tets, nodes: chunk.nodes, sponge: chunk.sponge })
            .collect()
    });
    Topology {
        tets: lattice.tets.clone(),
        vertex_color_start: lattice.vertex_color_start,
        slot_vertex_color: SLOT_VERTEX_COLOR,
        chunks,
    }
}

fn seed_fluid(scene: &Scene, params: &Params, columns: &mut Columns) {
    let Some(fluid) = &scene.fluid else { return };
    let spacing = fluid.spacing;
    let mut seeds = Seeds { columns, clearance: CLEARANCE * spacing, jitter: JITTER * spacing };
    for block in &fluid.blocks {
        let counts = block.counts(spacing);
        // What a sponge holds at time zero is its saturation, whatever block of water it stands in.
        let dry = |point: Vec3| !scene.sponges.iter().any(|sponge| holds(sponge, point));
        seeds.fill(block.minimum, [spacing; 3], counts, block.velocity, dry);
    }
    let volume = f64::from(params.fluid.particle_mass) / f64::from(fluid.rest_density);
    for (index, sponge) in scene.sponges.iter().enumerate().filter(|(_, sponge)| sponge.saturation > 0.0) {
        // As many particles as fill the pores, evenly over the inside of the true tets: boundary squares are pits
        // of half an edge, a sixth of an edge on average.
        let inset = Vec3::splat(sponge.edge / 6.0);
        let size = sponge.size() - inset * 2.0;
        let fraction = f64::from(sponge.porosity * sponge.saturation);
        let pitch = (volume / fraction).cbrt() as f32;
        let wanted = size.to_array().map(|size| size / pitch);
        let counts = match fluid.solver {
            // A few too many yield slowly to an equation of state.
            scene::FluidSolver::Wcsph => wanted.map(|count| count.round().max(1.0) as u32),
            scene::FluidSolver::Dfsph => filling(wanted),
        };
        let pitch = [0, 1, 2].map(|axis| size[axis] / counts[axis] as f32);
        let first_of = |other: &scene::Sponge, point: Vec3| other.saturation > 0.0 && holds(other, point);
        let keep = |point: Vec3| {
            holds(sponge, point) && !scene.sponges[..index].iter().any(|other| first_of(other, point))
        };
        seeds.fill(sponge.position + inset, pitch, counts, sponge.velocity, keep);
    }
    let count = columns.fluid.position.len();
    columns.rows.fluid = count;
    if count > 0 {
        columns.fluid.id = (0..count as u32).collect();
        columns.fluid.position.resize(padded(count), FAR_ROW);
        columns.fluid.velocity.resize(padded(count), [0.0; 4]);
    }
}

/// Whole numbers of particles along the axes, next to the given ones: as many particles as possible, but no more than
/// fit. A solve for the pressure presses out one too many in a row at the first step.
fn filling(wanted: [f32; 3]) -> [u32; 3] {
    let most = wanted.iter().product::<f32>() * 1.001;
    let corner = |bits: u32| {
        let mut counts = [1; 3];
        for (axis, count) in counts.iter_mut().enumerate() {
            *count = (wanted[axis].floor() as u32 + (bits >> axis & 1)).max(1);
        }
        counts
    };
    let particles = |counts: &[u32; 3]| counts.iter().product::<u32>();
    let fitting = (0..8).map(corner).filter(|counts| particles(counts) as f32 <= most);
    fitting.max_by_key(particles).unwrap_or_else(|| corner(0))
}

/// Whether a point lies inside the outline of a sponge.
fn holds(sponge: &scene::Sponge, point: Vec3) -> bool {
    let relative = (point - sponge.position) / sponge.size();
    let inside = relative.cmpge(Vec3::ZERO).all() && relative.cmple(Vec3::ONE).all();
    inside && mask(sponge.shape)(relative)
}

struct Seeds<'a> {
    columns: &'a mut Columns,
    clearance: f32,
    jitter: f32,
}

impl Seeds<'_> {
    /// A lattice of particles, those that `keep` refuses or that lie in bodies left out.
    fn fill(
        &mut self,
        corner: Vec3,
        pitch: [f32; 3],
        counts: [u32; 3],
        velocity: Vec3,
        keep: impl Fn(Vec3) -> bool,
    ) {
        for z in 0..counts[2] {
            for y in 0..counts[1] {
                for x in 0..counts[0] {
                    let steps = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
                    let point = corner + steps * Vec3::from_array(pitch);
                    let bodies = &self.columns.bodies.states.0;
                    if !keep(point) || bodies.iter().any(|body| body.distance(point) < self.clearance) {
                        continue;
                    }
                    let fluid = &mut self.columns.fluid;
                    let point = point + jitter(fluid.position.len() as u64) * self.jitter;
                    fluid.position.push([point.x, point.y, point.z, 0.0]);
                    fluid.velocity.push([velocity.x, velocity.y, velocity.z, 0.0]);
                }
            }
        }
    }
}

/// A displacement in [-1, 1]^3 that is a function of the index alone (splitmix64).
fn jitter(index: u64) -> Vec3 {
    let mut bits = index.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let unit = |shift: u32| ((bits >> shift) & 0xffff) as f32 / 32767.5 - 1.0;
    Vec3::new(unit(0), unit(16), unit(32))
}
