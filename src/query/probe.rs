//! What is at points.

use glam::{DVec3, Vec3};
use sorb_kernels::params::Params;

use super::{QueryError, WaterField, error};
use crate::{
    sponge::{Located, TetGrid},
    world::World,
};

/// What is at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Probe {
    /// Share of the space around the point that is water, about 0 to 1; in a sponge about its porosity at most.
    pub filled: f32,
    /// Mass of water over space around the point \[kg/m^3\].
    pub density: f32,
    /// Mean velocity of the water around the point \[m/s\]; zero where there is none.
    pub velocity: Vec3,
    /// Mean pressure of the water around the point \[Pa\], as [`World::particle_pressures`] has it; zero where there is none.
    pub pressure: f32,
    /// The sponge that the point lies in.
    pub sponge: Option<SpongeProbe>,
}

/// What a sponge is like at a point in it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SpongeProbe {
    /// Its number in the scene.
    pub sponge: usize,
    /// Water-filled pore volume over pore volume, about 0 to 1; zero without fluid.
    pub saturation: f32,
    /// Pressure of the water in the pores \[Pa\]; zero where there is none.
    pub pore_pressure: f32,
    /// Velocity of the material \[m/s\].
    pub velocity: Vec3,
    /// Volume over that at rest \[1\].
    pub volume_ratio: f32,
}

pub(super) fn probe(world: &World, points: &[Vec3]) -> Result<Vec<Probe>, QueryError> {
    error::check_points(points)?;
    if let Some(probes) = world.probe_on_device(points) {
        return Ok(probes);
    }
    let bounds = error::bounds(points);
    let water = WaterField::new(world, bounds);
    let (nodes, lattice) = (world.node_positions(), world.lattice());
    let edge = lattice.sponges.iter().map(|sponge| sponge.edge).fold(1e-4, f32::max);
    let tets = TetGrid::new((nodes, &lattice.tets), bounds, edge);
    let pressures = world.particle_pressures();
    let one = |point: &Vec3| {
        let mut found = around(world, &water, &pressures, *point);
        found.sponge = tets.find(*point).map(|located| in_sponge(world, &located, found.pressure));
        found
    };
    Ok(points.iter().map(one).collect())
}

/// The water around a point.
fn around(world: &World, water: &WaterField, pressures: &[f32], point: Vec3) -> Probe {
    let velocities = world.particle_velocities();
    let (mut filled, mut share_sum, mut velocity, mut pressure) = (0.0, 0.0, DVec3::ZERO, 0.0);
    water.around(point, |row, share| {
        filled += share;
        let Some(row) = row else { return };
        share_sum += share;
        if let (Some([x, y, z, _]), Some(own)) = (velocities.get(row), pressures.get(row)) {
            velocity += DVec3::new(f64::from(*x), f64::from(*y), f64::from(*z)) * share;
            pressure += f64::from(*own) * share;
        }
    });
    Probe::of_water([filled, share_sum, pressure], velocity, world.params.fluid.rest_density)
}

impl Probe {
    /// By the shares of particles with and without their images behind walls, and sums of share times pressure and velocity.
    pub(crate) fn of_water([filled, share, pressure]: [f64; 3], velocity: DVec3, rest_density: f32) -> Self {
        if share <= 0.0 {
            return Self::default();
        }
        Self {
            filled: filled as f32,
            density: filled as f32 * rest_density,
            velocity: (velocity / share).as_vec3(),
            pressure: (pressure / share) as f32,
            sponge: None,
        }
    }
}

impl SpongeProbe {
    /// Without saturation and velocity, in a tet of six times a volume \[m^3\], where the water has a pressure \[Pa\].
    pub(crate) fn of(world: &World, sponge: usize, volume: f64, pressure: f32) -> Self {
        let edge = f64::from(world.params.sponges[sponge].edge);
        // A tet at rest is a twelfth of its cube.
        let volume_ratio = (2.0 * volume / edge.powi(3)) as f32;
        let pore_pressure = pressure * pore_share(&world.params, sponge, volume_ratio);
        Self { sponge, saturation: 0.0, pore_pressure, velocity: Vec3::ZERO, volume_ratio }
    }
}

fn in_sponge(world: &World, located: &Located, pressure: f32) -> SpongeProbe {
    let lattice = world.lattice();
    let (nodes, sponge) = (lattice.tets[located.tet as usize], lattice.tet_sponge[located.tet as usize]);
    let rows = nodes.iter().zip(located.weights).map(|(node, weight)| (*node as usize, weight));
    let saturations = world.node_saturations();
    let (mut saturation, mut velocity) = (0.0, Vec3::ZERO);
    for (node, weight) in rows {
        saturation += weight * saturations.get(node).copied().unwrap_or(0.0);
        let [x, y, z, _] = world.node_velocities()[node];
        velocity += weight * Vec3::new(x, y, z);
    }
    let corners = nodes.map(|node| {
        let [x, y, z, _] = world.node_positions()[node as usize];
        Vec3::new(x, y, z).as_dvec3()
    });
    let [a, b, c, d] = corners;
    let volume = (b - a).cross(c - a).dot(d - a);
    SpongeProbe { saturation, velocity, ..SpongeProbe::of(world, sponge as usize, volume, pressure) }
}

/// Pressure in the pores over that of the particles there. With a pressure solve this is the porosity: neighbours fill the pores only,
/// see [`World::particle_pressures`].
fn pore_share(params: &Params, sponge: usize, volume_ratio: f32) -> f32 {
    if params.fluid.incompressible.is_none() || params.solid.is_none() {
        return 1.0;
    }
    (1.0 - (1.0 - params.sponges[sponge].porosity) / volume_ratio.max(1e-3)).clamp(0.0, 1.0)
}
