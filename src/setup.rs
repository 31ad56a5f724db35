//! From a scene to columns: seeds the water, fills the lattices, places the bodies.

mod overlap;
mod params;
mod seed;
mod shapes;

use glam::{Mat3, Quat, Vec3};
use sorb_kernels::{
    body::{Bodies, Body},
    column::{FAR_ROW, padded},
    columns::{Columns, RowCounts, lane},
    couple::interior::node_interior,
    cpu::Cpu,
    params::Params,
    pbd::{
        flatness::flatness,
        lattice::{TetChunk, Topology},
        stars::{Stars, TETS},
    },
    rounding::Rounding,
};

use crate::{
    rigid::{BodySetup, RigidEngine, check_engine},
    scene::{self, Scene},
    sponge::{self, Lattice, LatticeSponge, SLOT_VERTEX_COLOR},
    world::{Origin, WorldError},
};

pub(crate) use params::params;
pub(crate) use seed::{Beside, jitter, pores};
use shapes::Mask;
pub(crate) use shapes::mask;

/// Tets of a chunk that one thread solves at a time.
const TETS_PER_CHUNK: usize = 256;

/// What a world begins with beside its scene.
#[derive(Debug, Default)]
pub(crate) struct Begin {
    /// The engine of a host.
    pub(crate) engine: Option<Box<dyn RigidEngine>>,
    /// Whether the particles of the scene are left out.
    pub(crate) is_dry: bool,
    /// The bodies that the sponges were cut by, if they are not those of the scene.
    pub(crate) cut_by: Option<Vec<scene::Body>>,
    /// Whether there may be dynamic bodies although the scene has none.
    pub(crate) has_dynamics: bool,
}

/// All parts of a world at time zero.
pub(crate) struct Setup {
    pub(crate) params: Params,
    pub(crate) columns: Columns,
    pub(crate) lattice: Lattice,
    pub(crate) engine: Box<dyn RigidEngine>,
}

impl Setup {
    pub(crate) fn new(scene: &Scene, cpu: &Cpu, begin: Begin) -> Result<Self, WorldError> {
        let params = params(scene);
        let mut columns = Columns::default();
        let setups = body_setups(scene)?;
        let engine = match begin.engine {
            Some(own) => {
                check_engine(&*own, &setups)?;
                own
            }
            None => engine(scene, &setups, begin.has_dynamics)?,
        };
        place_bodies(scene, &setups, &*engine, &mut columns);
        let masks = shapes::masks(&scene.sponges)?;
        let lattice = match &begin.cut_by {
            Some(bodies) => lattice(scene, &masks, &cutters(scene, bodies)?)?,
            None => lattice(scene, &masks, &columns.bodies.states.0)?,
        };
        overlap::check(scene, &lattice)?;
        fill_nodes(scene, &params, &lattice, &mut columns);
        if scene.fluid.is_some() && !scene.sponges.is_empty() {
            columns.nodes.interior = cpu.enter(|| node_interior(cpu, &params, &columns));
        }
        if !begin.is_dry {
            seed::seed_fluid(scene, &masks, &params, &mut columns)?;
        }
        Ok(Self { params, columns, lattice, engine })
    }
}

/// Bodies where they were when the sponges were made.
fn cutters(scene: &Scene, bodies: &[scene::Body]) -> Result<Vec<Body>, WorldError> {
    bodies.iter().map(|body| Ok(cutter(body, &body_setup(body, spacing(scene))?))).collect()
}

/// The nodes of what commands have made of a scene, which nothing holds.
pub(crate) fn node_columns(
    scene: &Scene,
    params: &Params,
    cpu: &Cpu,
    origin: &Origin,
) -> Result<(Lattice, Columns), WorldError> {
    let masks = shapes::masks(&scene.sponges)?;
    let bodies = origin.cut_by.as_ref().unwrap_or(&scene.bodies);
    let lattice = lattice(scene, &masks, &cutters(scene, bodies)?)?;
    let mut columns = Columns::default();
    fill_nodes(scene, params, &lattice, &mut columns);
    if scene.fluid.is_some() {
        columns.nodes.interior = cpu.enter(|| node_interior(cpu, params, &columns));
    }
    Ok((lattice, columns))
}

/// The lattice of a sponge alone, which no body has cut.
pub(crate) fn sponge_lattice(sponge: &scene::Sponge) -> Result<Lattice, WorldError> {
    let scene = Scene::new("sponge").with_sponge(sponge.clone());
    lattice(&scene, &shapes::masks(&scene.sponges)?, &[])
}

/// The bodies of a scene as an engine takes them, in order: shapes about their centres of mass, and states at time zero. For hosts that
/// give [`World::with_engine`](crate::World::with_engine) their own.
///
/// # Errors
/// The corners of a hull span no volume, or hulls need the feature `rigid`.
pub fn body_setups(scene: &Scene) -> Result<Vec<BodySetup>, WorldError> {
    scene.bodies.iter().map(|body| body_setup(body, spacing(scene))).collect()
}

/// Spacing of the particles; 0 without water \[m\].
fn spacing(scene: &Scene) -> f32 {
    scene.fluid.as_ref().map_or(0.0, |fluid| fluid.spacing)
}

pub(crate) fn body_setup(body: &scene::Body, spacing: f32) -> Result<BodySetup, WorldError> {
    let (shape, centre) = shapes::shape_of(body, spacing)?;
    let mut state = body.start();
    state.position += state.rotation * centre;
    Ok(BodySetup {
        name: body.name.clone(),
        shape,
        kind: body.kind,
        density: body.density,
        state,
        friction: body.friction,
        restitution: body.restitution,
        motions: body.motions.clone(),
    })
}

/// The engine of the library that moves the bodies of a scene: one that can have dynamic bodies if there are any, or may come.
pub(crate) fn engine(
    scene: &Scene,
    setups: &[BodySetup],
    may_be_dynamic: bool,
) -> Result<Box<dyn RigidEngine>, WorldError> {
    #[cfg(feature = "rigid")]
    if may_be_dynamic || setups.iter().any(|setup| setup.kind == sorb_kernels::body::BodyKind::Dynamic) {
        let container = match scene.domain {
            scene::Domain::Box { minimum, maximum, periodic } => {
                let open = Vec3::splat(f32::INFINITY);
                let corner = |own: Vec3, far: Vec3| Vec3::select(periodic.into(), far, own);
                Some((corner(minimum, -open), corner(maximum, open)))
            }
            scene::Domain::Open => None,
        };
        return Ok(Box::new(crate::rigid::RapierEngine::new(scene.gravity, container, setups)?));
    }
    let _ = (scene, may_be_dynamic);
    Ok(Box::new(crate::rigid::ScriptedEngine::new(setups)?))
}

/// A body before any step, as sponges are cut by it.
pub(crate) fn cutter(body: &scene::Body, setup: &BodySetup) -> Body {
    Body {
        shape: setup.shape.clone(),
        kind: setup.kind,
        state: setup.state,
        friction: body.friction,
        touches_nodes: !body.grip,
        no_slip: body.no_slip,
        rounding: Rounding::default(),
        inverse_mass: 0.0,
        inverse_inertia: Mat3::ZERO,
    }
}

fn place_bodies(scene: &Scene, setups: &[BodySetup], engine: &dyn RigidEngine, columns: &mut Columns) {
    let spacing = spacing(scene);
    let bodies = setups.iter().zip(&scene.bodies).enumerate().map(|(index, (setup, body))| Body {
        shape: setup.shape.clone(),
        kind: setup.kind,
        state: engine.state(index),
        friction: body.friction,
        touches_nodes: !body.grip,
        no_slip: body.no_slip,
        rounding: Rounding::new(&setup.shape, spacing),
        inverse_mass: engine.inverse_mass(index),
        inverse_inertia: engine.inverse_inertia(index),
    });
    columns.bodies.states = Bodies(bodies.collect());
    columns.rows.bodies = setups.len();
}

/// Depth in a body at which a node may begin, over the edge of a cell: contact, and rounding.
pub(crate) const TOUCH: f32 = 1.0e-3;

/// The sponges, without cells that begin inside a body: these would be thrown out of it. Grips hold the nodes that they
/// contain instead. Sponges that were added later are not cut.
fn lattice(scene: &Scene, masks: &[Mask], bodies: &[Body]) -> Result<Lattice, WorldError> {
    let rooms: Vec<_> = scene
        .sponges
        .iter()
        .map(|sponge| {
            let (origin, size, depth) = (sponge.position, sponge.size(), TOUCH * sponge.edge);
            let is_uncut = sponge.added;
            move |place: Vec3| {
                let point = origin + place * size;
                is_uncut || !bodies.iter().any(|body| body.touches_nodes && body.distance(point) < -depth)
            }
        })
        .collect();
    let sponges: Vec<_> = scene
        .sponges
        .iter()
        .zip(masks.iter().zip(&rooms))
        .map(|(sponge, (mask, room))| LatticeSponge {
            edge: sponge.edge,
            cells: sponge.cells.to_array(),
            // Where removed ones are, a lattice has no digits left.
            origin: if sponge.is_removed() { Vec3::ZERO } else { sponge.position },
            keep: if sponge.is_removed() { &|_| false } else { &**mask },
            has_room: room,
            may_be_empty: sponge.is_removed(),
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
    if params.has_touch() {
        nodes.rest.clone_from(&lattice.position);
        let flat = flatness(&lattice.tets, &lattice.position);
        nodes.rest.iter_mut().zip(flat).for_each(|(row, flat)| row[lane::nodes::rest::FLATNESS] = flat);
        nodes.rest.resize(rows, FAR_ROW);
    }
    nodes.volume.clone_from(&lattice.node_volume);
    nodes.sponge.clone_from(&lattice.node_sponge);
    nodes.suction = suction(params, lattice);
    nodes.velocity = lattice
        .node_sponge
        .iter()
        .map(|sponge| {
            let [x, y, z] = scene.sponges[*sponge as usize].velocity.to_array();
            [x, y, z, 0.0]
        })
        .collect();
    if params.solid.is_some() && params.has_wetting() {
        // Dry, and no water has receded yet.
        nodes.wetting = vec![[0.0; 4]; rows];
    }
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
                nodes.position[node][lane::nodes::position::INVERSE_MASS] = 0.0;
            }
            None => {
                nodes.position[node][lane::nodes::position::INVERSE_MASS] =
                    1.0 / (sponge.density * lattice.node_volume[node])
            }
        }
    }
    nodes.position.resize(rows, FAR_ROW);
    nodes.velocity.resize(rows, [0.0; 4]);
    nodes.topology = topology(lattice);
    nodes.stars = Stars::new(&nodes.topology, &lattice.position, &lattice.node_sponge);
    debug_assert_eq!(params.sponges.len(), scene.sponges.len());
}

/// Suction flags of the nodes: 1 or 0. Nodes of the surface have none, so that no layer of water forms around the sponge.
/// With porous media these are only the nodes of the outermost layer, with at most half as many tets as an inner node.
fn suction(params: &Params, lattice: &Lattice) -> Vec<f32> {
    let sucks = |node: usize| {
        if params.solid.is_none() {
            return !lattice.node_surface[node];
        }
        2 * lattice.node_tet_count[node] > TETS as u32
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
        weights: lattice.tet_weight.clone(),
        vertex_color_start: lattice.vertex_color_start,
        slot_vertex_color: SLOT_VERTEX_COLOR,
        chunks,
    }
}
