//! Particles of blocks of water and of sponges that are wet at time zero.

use std::collections::BTreeMap;

use glam::Vec3;
use sorb_kernels::{
    body::{Body, pieces},
    column::{FAR_ROW, padded},
    columns::{Columns, lane},
    params::Params,
};

use super::shapes::{Mask, mask};
use crate::{
    scene::{self, BlockShape, Scene},
    world::WorldError,
};

/// Displacement of initial particles over the spacing: a perfect lattice hides errors that depend on the order of particles.
const JITTER: f32 = 0.01;
/// Distance from a body, over the spacing, within which there are no initial particles.
const CLEARANCE: f32 = 0.4;
/// The same with a solve for the divergence, which counts the volume that bodies displace. Particles are as many as fit beside
/// them, and those nearer than this are moved away.
const MARGIN: f32 = 0.1;

pub(super) fn seed_fluid(
    scene: &Scene,
    masks: &[Mask],
    params: &Params,
    columns: &mut Columns,
) -> Result<(), WorldError> {
    let Some(fluid) = &scene.fluid else { return Ok(()) };
    let spacing = fluid.spacing;
    let room = Beside::new(params, &columns.bodies.states.0);
    let mut seeds = Seeds { columns, room, spacing };
    for (index, block) in fluid.blocks.iter().enumerate() {
        let (counts, pitch) = block.lattice(scene, spacing);
        let (corner, size) = (block.minimum, block.maximum - block.minimum);
        let shape = mask(&block.shape, size, &format!("fluid.blocks[{index}]"))?;
        let is_whole = block.shape == BlockShape::Block;
        // The saturation of a sponge is its initial water, whatever block of water it stands in.
        let dry =
            |point: Vec3| !scene.sponges.iter().zip(masks).any(|(sponge, mask)| holds(sponge, mask, point));
        let keep = |point: Vec3| (is_whole || BlockShape::holds(&shape, (corner, size), point)) && dry(point);
        seeds.fill(block.minimum, pitch, counts, block.velocity, keep);
    }
    for (index, sponge) in scene.sponges.iter().enumerate().filter(|(_, sponge)| sponge.saturation > 0.0) {
        let (counts, pitch) = pore_lattice(scene, sponge, params);
        let before =
            || scene.sponges.iter().zip(masks).take(index).filter(|(other, _)| other.saturation > 0.0);
        let keep = |point: Vec3| {
            holds(sponge, &masks[index], point) && !before().any(|(other, mask)| holds(other, mask, point))
        };
        seeds.fill(sponge.position, pitch, counts, sponge.velocity, keep);
    }
    let count = columns.fluid.position.len();
    columns.rows.fluid = count;
    if count > 0 {
        columns.fluid.id = (0..count as u32).collect();
        columns.fluid.position.resize(padded(count), FAR_ROW);
        columns.fluid.velocity.resize(padded(count), [0.0; 4]);
    }
    if params.fluid.divergence().is_some() {
        rest_pressures(scene, params, columns);
    }
    Ok(())
}

/// Distance of particles above each other over the spacing up to which they are one column of water.
const GAP: f32 = 1.5;

/// The kinematic pressure of water that rests on the floor of the container. A solve that begins at zero needs as many rounds as there are
/// pairs of layers.
fn rest_pressures(scene: &Scene, params: &Params, columns: &mut Columns) {
    let down = scene.gravity.abs().max_position();
    let Some((low, high)) = params.walls else { return };
    let others = [(down + 1) % 3, (down + 2) % 3];
    let is_inverted = scene.gravity[down] > 0.0;
    let height = |row: &[f32; 4]| if is_inverted { high[down] - row[down] } else { row[down] - low[down] };
    let (spacing, gravity) = (params.fluid.spacing, scene.gravity.length());
    let mut by_column: BTreeMap<[i64; 2], Vec<usize>> = BTreeMap::new();
    for (row, position) in columns.fluid.position[..columns.rows.fluid].iter().enumerate() {
        let place = others.map(|axis| (position[axis] / spacing).floor() as i64);
        by_column.entry(place).or_default().push(row);
    }
    for rows in by_column.values_mut() {
        rows.sort_by(|a, b| {
            height(&columns.fluid.position[*a]).total_cmp(&height(&columns.fluid.position[*b]))
        });
        let heights: Vec<f32> = rows.iter().map(|row| height(&columns.fluid.position[*row])).collect();
        let below = |place: usize| place.checked_sub(1).map_or(0.0, |below| heights[below]);
        let end = (0..rows.len()).find(|place| heights[*place] - below(*place) > GAP * spacing);
        let end = end.unwrap_or(rows.len());
        let Some(top) = end.checked_sub(1).map(|last| heights[last] + 0.5 * spacing) else { continue };
        for (row, height) in rows[..end].iter().zip(&heights) {
            columns.fluid.velocity[*row][lane::fluid::velocity::PRESSURE] = gravity * (top - height);
        }
    }
}

/// Whole numbers of particles along the axes, close to the given ones: as many particles as possible, but no more than fit.
/// A pressure solve presses out a surplus particle in the first step.
fn filling(wanted: [f32; 3]) -> [u32; 3] {
    let maximum = wanted.iter().product::<f32>() * 1.001;
    let corner = |bits: u32| {
        let mut counts = [1; 3];
        for (axis, count) in counts.iter_mut().enumerate() {
            *count = (wanted[axis].floor() as u32 + (bits >> axis & 1)).max(1);
        }
        counts
    };
    let particles = |counts: &[u32; 3]| counts.iter().product::<u32>();
    let fitting = (0..8).map(corner).filter(|counts| particles(counts) as f32 <= maximum);
    fitting.max_by_key(particles).unwrap_or_else(|| corner(0))
}

/// As many particles along the axes of a sponge as fill its pores, evenly spaced, and their distance there \[m\].
fn pore_lattice(scene: &Scene, sponge: &scene::Sponge, params: &Params) -> ([u32; 3], [f32; 3]) {
    let rest_density = f64::from(params.fluid.rest_density);
    let volume = f64::from(params.fluid.particle_mass) / rest_density;
    let size = sponge.size();
    let fraction = f64::from(sponge.porosity * sponge.saturation);
    let pitch = (volume / fraction).cbrt() as f32;
    let wanted = size.to_array().map(|size| size / pitch);
    let counts = match scene.fluid_solver() {
        // An equation of state tolerates a few too many.
        Some(scene::FluidSolver::Wcsph) => wanted.map(|count| count.round().max(1.0) as u32),
        _ => filling(wanted),
    };
    (counts, [0, 1, 2].map(|axis| size[axis] / counts[axis] as f32))
}

/// Particles in the pores of a sponge beside bodies \[m\].
pub(crate) fn pores(
    scene: &Scene,
    sponge: &scene::Sponge,
    params: &Params,
    bodies: &[Body],
) -> Result<Vec<Vec3>, WorldError> {
    if sponge.saturation <= 0.0 {
        return Ok(Vec::new());
    }
    let mask = mask(&sponge.shape, sponge.size(), &format!("sponge `{}`", sponge.name))?;
    let room = Beside::new(params, bodies);
    let (counts, pitch) = pore_lattice(scene, sponge, params);
    let points = lattice_points(sponge.position, pitch, counts);
    let inside = points.filter(|point| holds(sponge, &mask, *point));
    Ok(inside.filter_map(|point| room.outside(point)).collect())
}

/// Centres of the cells of a lattice \[m\].
fn lattice_points(corner: Vec3, pitch: [f32; 3], counts: [u32; 3]) -> impl Iterator<Item = Vec3> {
    let [nx, ny, nz] = counts;
    let indices = (0..nz).flat_map(move |z| (0..ny).flat_map(move |y| (0..nx).map(move |x| [x, y, z])));
    indices.map(move |[x, y, z]| {
        let steps = Vec3::new(x as f32, y as f32, z as f32) + 0.5;
        corner + steps * Vec3::from_array(pitch)
    })
}

/// Whether a point lies inside the outline of a sponge.
fn holds(sponge: &scene::Sponge, mask: &Mask, point: Vec3) -> bool {
    BlockShape::holds(mask, (sponge.position, sponge.size()), point)
}

/// The room for new particles beside bodies.
#[derive(Clone, Debug)]
pub(crate) struct Beside {
    /// Convex pieces of bodies, and the radius of the balls that sweep them \[m\].
    bodies: Vec<(Body, f32)>,
    /// Distance from bodies within which there are no particles \[m\], and to which those that are nearer are moved.
    clearance: f32,
    margin: f32,
}

impl Beside {
    pub(crate) fn new(params: &Params, bodies: &[Body]) -> Self {
        let spacing = params.fluid.spacing;
        let as_cores = params.fluid.divergence().is_some();
        let clearance = if as_cores { 0.0 } else { CLEARANCE * spacing };
        let bodies = pieces(bodies, as_cores);
        let margin = if clearance > 0.0 { 0.0 } else { MARGIN * spacing };
        Self { bodies, clearance, margin }
    }

    /// The point, away from the surfaces of bodies; none inside.
    pub(crate) fn outside(&self, mut point: Vec3) -> Option<Vec3> {
        for (body, radius) in &self.bodies {
            let (distance, normal) = body.distance_and_normal(point);
            let distance = distance - radius;
            if distance < self.clearance {
                return None;
            }
            point += normal * (self.margin - distance).max(0.0);
        }
        Some(point)
    }
}

struct Seeds<'a> {
    columns: &'a mut Columns,
    room: Beside,
    spacing: f32,
}

impl Seeds<'_> {
    /// A lattice of particles, without those that `keep` refuses or that lie in bodies.
    fn fill(
        &mut self,
        corner: Vec3,
        pitch: [f32; 3],
        counts: [u32; 3],
        velocity: Vec3,
        keep: impl Fn(Vec3) -> bool,
    ) {
        for point in lattice_points(corner, pitch, counts) {
            let Some(free) = self.room.outside(point).filter(|_| keep(point)) else { continue };
            let fluid = &mut self.columns.fluid;
            let point = free + jitter(fluid.position.len() as u64, self.spacing);
            fluid.position.push([point.x, point.y, point.z, 0.0]);
            fluid.velocity.push([velocity.x, velocity.y, velocity.z, 0.0]);
        }
    }
}

/// A small displacement \[m\] of particles some spacing apart that is a function of the index alone (splitmix64).
pub(crate) fn jitter(index: u64, spacing: f32) -> Vec3 {
    let mut bits = index.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x9e37_79b9_7f4a_7c15);
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^= bits >> 31;
    let unit = |shift: u32| ((bits >> shift) & 0xffff) as f32 / 32767.5 - 1.0;
    Vec3::new(unit(0), unit(16), unit(32)) * (JITTER * spacing)
}
