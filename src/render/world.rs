//! Pictures of a world.

use std::borrow::Cow;

use super::{Camera, DrawnBody, Image, Look, Picture, View, draw, section};
use crate::rigid::BodyKind;
use crate::scene::{self, Domain};
use crate::{World, glam::Vec3};

/// Draws a world as `camera` sees it into an image of `width` x `height` pixels.
///
/// Looks and colours are those of the scene. Take `world.scene().viewpoint().into()` for its camera.
#[must_use]
pub fn draw_world(world: &World, camera: &Camera, view: View, width: u32, height: u32) -> Image {
    draw_positions(world, &Seen::of(world), camera, view, (width, height))
}

/// What a picture shows of the state of a world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub(super) particles: &'a [[f32; 4]],
    pub(super) velocities: &'a [[f32; 4]],
    pub(super) interior: &'a [f32],
    pub(super) nodes: &'a [[f32; 4]],
    pub(super) saturations: &'a [f32],
}

impl<'a> Seen<'a> {
    /// The present state.
    pub(super) fn of(world: &'a World) -> Self {
        Self {
            particles: world.particle_positions(),
            velocities: world.particle_velocities(),
            interior: &world.columns().fluid.interior,
            nodes: world.node_positions(),
            saturations: world.node_saturations(),
        }
    }
}

/// Draws a world in another state than its own.
pub(super) fn draw_positions(
    world: &World,
    seen: &Seen<'_>,
    camera: &Camera,
    view: View,
    (width, height): (u32, u32),
) -> Image {
    let pressures = if view == View::Pressure { world.particle_pressures() } else { Vec::new() };
    with_picture(world, (seen, &pressures), camera, view, |picture| draw(picture, camera, width, height))
}

/// Gives the picture of a world in some state, with the pressures of its particles, to somebody who draws it.
pub(super) fn with_picture<R>(
    world: &World,
    (seen, pressures): (&Seen<'_>, &[f32]),
    camera: &Camera,
    view: View,
    draw: impl FnOnce(&Picture<'_>) -> R,
) -> R {
    let bodies: Vec<DrawnBody<'_>> = world
        .bodies()
        .iter()
        .zip(&world.scene().bodies)
        .filter(|(_, keys)| !keys.is_removed())
        .map(|(body, keys)| DrawnBody {
            shape: &body.shape,
            state: body.state,
            look: keys.look.unwrap_or(if body.kind == BodyKind::Kinematic {
                Look::Glass
            } else {
                Look::Solid
            }),
            colour: keys.colour,
        })
        .collect();
    let surfaces = Surfaces::new(world, (seen.nodes, seen.saturations), view);
    let places = if seen.nodes.is_empty() { seen.particles } else { seen.nodes };
    let section = (view == View::Cutaway).then(|| section::plane(places, camera.eye));
    let halves = section.map(|plane| section::behind(world, seen.nodes, plane));
    let (fluid, water) = (world.scene().fluid.as_ref(), Picture::default());
    draw(&Picture {
        particles: seen.particles,
        velocities: seen.velocities,
        particle_radius: 0.5 * world.params.fluid.spacing,
        interior: seen.interior,
        nodes: &surfaces.nodes,
        wetness: &surfaces.wetness,
        rest: &surfaces.rest,
        triangles: halves.as_deref().unwrap_or(&surfaces.triangles),
        skin: &surfaces.skin,
        bodies: &bodies,
        container: match world.scene().domain {
            Domain::Box { minimum, maximum, .. } => Some((minimum, maximum)),
            Domain::Open => None,
        },
        absorption: fluid.and_then(|fluid| fluid.absorption).unwrap_or(water.absorption),
        scatter: fluid.and_then(|fluid| fluid.colour).unwrap_or(water.scatter),
        pressures,
        range: range(world, view),
        section,
        view,
    })
}

/// The sponges with the corners of their skins after the nodes.
struct Surfaces<'a> {
    nodes: Cow<'a, [[f32; 4]]>,
    wetness: Vec<f32>,
    rest: Cow<'a, [[f32; 4]]>,
    /// Those of sponges without a skin.
    triangles: Cow<'a, [[u32; 3]]>,
    skin: Vec<[u32; 3]>,
}

impl<'a> Surfaces<'a> {
    fn new(world: &'a World, (nodes, saturations): (&'a [[f32; 4]], &[f32]), view: View) -> Self {
        let lattice = world.lattice();
        let mut all = Self {
            nodes: nodes.into(),
            wetness: wetness(world, saturations),
            rest: lattice.position.as_slice().into(),
            triangles: lattice.triangles.as_slice().into(),
            skin: Vec::new(),
        };
        let skins = world.skins();
        // A section goes through tets, and nodes are those of the lattice.
        if matches!(view, View::Nodes | View::Cutaway) || skins.iter().all(Option::is_none) {
            return all;
        }
        let has_none = |(_, sponge): &(&[u32; 3], &u32)| skins[**sponge as usize].is_none();
        let own = lattice.triangles.iter().zip(&lattice.triangle_sponge).filter(has_none);
        all.triangles = own.map(|(triangle, _)| *triangle).collect();
        for skin in skins.iter().flatten() {
            let first = all.nodes.len() as u32;
            let row = |place: Vec3| place.extend(0.0).to_array();
            let wetness: Vec<f32> = skin.values(&all.wetness).collect();
            all.wetness.extend(wetness);
            all.nodes.to_mut().extend(skin.positions(nodes).map(row));
            all.rest.to_mut().extend(skin.positions(&lattice.position).map(row));
            all.skin.extend(skin.triangles().iter().map(|corners| corners.map(|corner| first + corner)));
        }
        all
    }
}

/// Range of a colour map: the same for all pictures of a scene.
pub(super) fn range(world: &World, view: View) -> (f32, f32) {
    let scene = world.scene();
    let (low, high) = scene.bounds();
    let gravity = scene.gravity.length();
    let height = high.y - low.y;
    let density = scene.fluid.as_ref().map_or(1000.0, |fluid| fluid.rest_density);
    match view {
        // That of water that stands a fifth as high as the scene, and of a fall through a quarter of it.
        View::Pressure => (0.0, round(0.2 * density * gravity * height)),
        View::Speed => (0.0, round((0.5 * gravity * height).sqrt())),
        _ => (0.0, 1.0),
    }
}

/// The nearest of 1, 2 and 5 times a power of ten above a value.
fn round(value: f32) -> f32 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let power = libm::powf(10.0, libm::log10f(value).floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|lead| lead * power)
        .find(|round| *round >= 0.999 * value)
        .unwrap_or(value)
}

/// Drawn wetness of each node; before the first step that of the scene.
///
/// The outermost nodes have no suction, and the water stays one layer below them. The surface looks as wet as the layer
/// below it.
fn wetness(world: &World, saturations: &[f32]) -> Vec<f32> {
    let lattice = world.lattice();
    if saturations.is_empty() {
        let sponges = &world.scene().sponges;
        return lattice.node_sponge.iter().map(|&sponge| sponges[sponge as usize].saturation).collect();
    }
    let mut wetness: Vec<f32> = saturations.iter().map(|saturation| saturation.clamp(0.0, 1.0)).collect();
    // Twice: an edge of the block has no inner neighbours, only nodes of the faces.
    let mut known: Vec<bool> = lattice.node_surface.iter().map(|surface| !surface).collect();
    for _ in 0..2 {
        let mut sums = vec![(0.0, 0.0_f32); wetness.len()];
        for tet in &lattice.tets {
            let nodes = tet.map(|node| node as usize);
            for node in nodes.into_iter().filter(|node| !known[*node]) {
                for under in nodes.into_iter().filter(|under| known[*under]) {
                    sums[node].0 += wetness[under];
                    sums[node].1 += 1.0;
                }
            }
        }
        for (node, (sum, count)) in sums.into_iter().enumerate().filter(|(_, (_, count))| *count > 0.0) {
            wetness[node] = wetness[node].max(sum / count);
            known[node] = true;
        }
    }
    wetness
}

impl From<scene::Camera> for Camera {
    fn from(camera: scene::Camera) -> Self {
        Self {
            eye: camera.eye,
            target: camera.target,
            up: Vec3::Y,
            field_of_view: camera.field_of_view_degrees.to_radians(),
        }
    }
}

#[cfg(all(test, feature = "serde"))]
mod tests {
    use super::*;

    #[test]
    fn the_skin_of_a_soaked_sponge_looks_wet_up_to_its_edges() {
        let world = |overrides: &[&str]| {
            let scene = scene::preset("squish");
            let scene = scene.and_then(|scene| scene.with_overrides(overrides.iter().copied()));
            World::new(&scene.unwrap_or_else(|error| panic!("{error}")))
                .unwrap_or_else(|error| panic!("{error}"))
        };
        let lowest = |wetness: &[f32]| wetness.iter().copied().fold(1.0, f32::min);
        // Enough to hold the water up to its top.
        let mut soaked = world(&["sponges.sponge.entry_pressure=1500"]);
        for _ in 0..6 {
            soaked.advance_frame().unwrap_or_else(|error| panic!("{error}"));
        }
        let (skin, drawn) =
            (lowest(soaked.node_saturations()), lowest(&wetness(&soaked, soaked.node_saturations())));
        // Negative control: the drawn wetness is not that of the outermost nodes.
        assert!(skin < 0.4, "{skin}");
        assert!(drawn > 0.6, "{drawn}");
        let dry = world(&["sponges.sponge.saturation=0"]);
        assert!(wetness(&dry, dry.node_saturations()).iter().all(|wet| *wet < 0.05));
    }
}
