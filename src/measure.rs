//! Measures of a state in f64, for conservation, validation and tables.

use glam::DVec3;
use sorb_kernels::{
    columns::lane::nodes::wetting::WETNESS,
    params::{INSIDE, POLYNOMIAL_RATIO, Solver, SpongeParams, WET},
    pbd::wetted::of_tet,
};

use crate::{World, rigid::Mechanics};

/// Masses, momenta, energies and errors of one state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Simulated time \[s\].
    pub time: f64,
    /// Mass of all water \[kg\].
    pub water_mass: f64,
    /// Mass of the water inside sponges \[kg\].
    pub absorbed_mass: f64,
    /// Water-filled pore volume over pore volume at rest \[1\]: the mean over the nodes. With porous media the mass of the
    /// water inside over that which full pores hold. A swollen sponge has more pore volume.
    pub saturation: f64,
    /// Height of the highest node that is more than half saturated, above the lowest node \[m\].
    pub wicking_height: f64,
    /// Volume of all sponges \[m^3\], pores included. A block at rest has the volume of its box.
    pub sponge_volume: f64,
    /// Centre of mass of the dry sponges \[m\].
    pub sponge_centre: DVec3,
    /// Momentum of water, sponges and bodies \[kg m/s\].
    pub linear_momentum: DVec3,
    /// Angular momentum about the origin \[kg m^2/s\].
    pub angular_momentum: DVec3,
    /// Kinetic energy \[J\].
    pub kinetic_energy: f64,
    /// Potential energy in the gravity field, zero at the origin \[J\].
    pub potential_energy: f64,
    /// Elastic energy of the sponges \[J\].
    pub elastic_energy: f64,
    /// Largest speed of particles and nodes \[m/s\].
    pub maximum_speed: f64,
    /// Mean of `max(rho / rho_0 - 1, 0)` over the particles \[1\]. With the boundary volume fraction where the solver of the
    /// fluid has one.
    pub mean_density_error: f64,
    /// Largest `rho / rho_0 - 1`, at least zero \[1\].
    pub maximum_density_error: f64,
}

impl Measures {
    /// All of them by name: one number, or the three of a vector.
    #[must_use]
    pub fn named(&self) -> [(&'static str, Vec<f64>); 15] {
        let vector = |vector: DVec3| vector.to_array().to_vec();
        [
            ("time", vec![self.time]),
            ("water_mass", vec![self.water_mass]),
            ("absorbed_mass", vec![self.absorbed_mass]),
            ("saturation", vec![self.saturation]),
            ("wicking_height", vec![self.wicking_height]),
            ("sponge_volume", vec![self.sponge_volume]),
            ("sponge_centre", vector(self.sponge_centre)),
            ("linear_momentum", vector(self.linear_momentum)),
            ("angular_momentum", vector(self.angular_momentum)),
            ("kinetic_energy", vec![self.kinetic_energy]),
            ("potential_energy", vec![self.potential_energy]),
            ("elastic_energy", vec![self.elastic_energy]),
            ("maximum_speed", vec![self.maximum_speed]),
            ("mean_density_error", vec![self.mean_density_error]),
            ("maximum_density_error", vec![self.maximum_density_error]),
        ]
    }

    pub(crate) fn of(world: &World) -> Self {
        let mut measures = Self { time: world.clock().time, ..Self::default() };
        let device = world.stores.device.as_ref();
        if !device.is_some_and(|device| device.add_sums(world, &mut measures)) {
            measures.add_water(world);
            measures.add_sponges(world);
        }
        for body in 0..world.bodies().len() {
            if let Some(body) = Mechanics::of(world.rigid_engine(), body, world.params.gravity) {
                measures.linear_momentum += body.linear_momentum;
                measures.angular_momentum += body.angular_momentum;
                measures.kinetic_energy += body.kinetic_energy;
                measures.potential_energy += body.potential_energy;
            }
        }
        measures
    }

    fn add_point(&mut self, mass: f64, position: DVec3, velocity: DVec3, gravity: DVec3) {
        self.linear_momentum += velocity * mass;
        self.angular_momentum += position.cross(velocity) * mass;
        self.kinetic_energy += 0.5 * mass * velocity.length_squared();
        self.potential_energy -= mass * gravity.dot(position);
        self.maximum_speed = self.maximum_speed.max(velocity.length());
    }

    fn add_water(&mut self, world: &World) {
        let fluid = &world.columns().fluid;
        let (mass, gravity) = (f64::from(world.params.fluid.particle_mass), world.params.gravity.as_dvec3());
        let count = world.particle_positions().len();
        for (position, velocity) in world.particle_positions().iter().zip(world.particle_velocities()) {
            self.add_point(mass, vector(position), vector(velocity), gravity);
        }
        self.water_mass = mass * count as f64;
        let inside = fluid.interior.iter().take(count).filter(|interior| **interior > INSIDE).count();
        self.absorbed_mass = mass * inside as f64;
        for filled in world.filled() {
            let error = (filled - 1.0).max(0.0);
            self.mean_density_error += error / count as f64;
            self.maximum_density_error = self.maximum_density_error.max(error);
        }
    }

    fn add_sponges(&mut self, world: &World) {
        let (lattice, scene) = (world.lattice(), world.scene());
        let gravity = world.params.gravity.as_dvec3();
        let (mut mass, mut volume, mut pores, mut lowest) = (0.0, 0.0, 0.0, f64::INFINITY);
        for (node, position) in world.node_positions().iter().enumerate() {
            let sponge = &scene.sponges[lattice.node_sponge[node] as usize];
            let node_volume = f64::from(lattice.node_volume[node]);
            let node_mass = node_volume * f64::from(sponge.density);
            let position = vector(position);
            self.add_point(node_mass, position, vector(&world.node_velocities()[node]), gravity);
            self.sponge_centre += position * node_mass;
            let wetness = world.columns().nodes.wetting.get(node).map_or(0.0, |row| f64::from(row[WETNESS]));
            let swollen = (1.0 + f64::from(sponge.swelling) * wetness).powi(3);
            pores += node_volume * (swollen - 1.0 + f64::from(sponge.porosity));
            mass += node_mass;
            lowest = lowest.min(position.y);
            if let Some(saturation) = world.node_saturations().get(node) {
                self.saturation += f64::from(*saturation) * node_volume;
                volume += node_volume;
                if *saturation > WET {
                    self.wicking_height = self.wicking_height.max(position.y);
                }
            }
        }
        if mass > 0.0 {
            self.sponge_centre /= mass;
        }
        if volume > 0.0 {
            self.saturation /= volume;
        }
        if world.params.solid.is_some() && pores > 0.0 {
            // Around nodes at a face there is water outside as well.
            self.saturation = self.absorbed_mass / (pores * f64::from(world.params.fluid.rest_density));
        }
        self.wicking_height = (self.wicking_height - lowest).max(0.0);
        self.add_tets(world);
    }

    /// Volume and elastic energy of the tets.
    fn add_tets(&mut self, world: &World) {
        let (nodes, lattice) = (world.node_positions(), world.lattice());
        let weights = lattice.tet_weight.iter().map(|weight| f64::from(*weight));
        for ((tet, sponge), weight) in lattice.tets.iter().zip(&lattice.tet_sponge).zip(weights) {
            let sponge = &world.params.sponges[*sponge as usize];
            let (size, stiffness) = of_tet(world.columns(), sponge, tet);
            let edge = f64::from(sponge.edge) * size;
            let [p0, p1, p2, p3] = tet.map(|node| vector(&nodes[node as usize]));
            let (d, e, f) = ((p1 - p0) / edge, (p2 - p3) / edge, (p2 + p3 - p0 - p1) / edge);
            let ratio = d.dot(e.cross(f));
            let rest = edge.powi(3) / 12.0;
            self.sponge_volume += weight * rest * ratio;
            // The constraints of strain based dynamics use no tet weights.
            let strained = if sponge.solver == Solver::Sbd { 1.0 } else { weight };
            self.elastic_energy += strained * rest * stiffness * energy_density(sponge, [d, e, f], ratio);
        }
    }
}

/// Energy of a tet over its volume at rest \[Pa\], as the solver of its sponge defines it; zero at rest.
fn energy_density(sponge: &SpongeParams, columns: [DVec3; 3], ratio: f64) -> f64 {
    let (mu, lambda) = (f64::from(sponge.mu), f64::from(sponge.lambda));
    let square: f64 = columns.iter().map(|column| column.length_squared()).sum();
    if sponge.solver == Solver::Vbd {
        let minimum = ratio.max(POLYNOMIAL_RATIO);
        let beyond = ratio / minimum - 1.0;
        let logarithm = libm::log(minimum) + beyond - 0.5 * beyond * beyond;
        let volume = (lambda - mu) * (ratio - 1.0).powi(2);
        return 0.5 * (mu * (square - 3.0 - 2.0 * logarithm) + volume);
    }
    if sponge.solver == Solver::XpbdNeoHookean {
        let alpha = 1.0 + mu / lambda;
        let rest = (1.0 - alpha).powi(2);
        return 0.5 * (mu * (square - 3.0) + lambda * ((ratio - alpha).powi(2) - rest));
    }
    let [d, e, f] = columns;
    let stretch: f64 = columns.iter().map(|column| (column.length() - 1.0).powi(2)).sum();
    let shear = d.dot(e).powi(2) + d.dot(f).powi(2) + e.dot(f).powi(2);
    0.5 * (f64::from(sponge.stretch_modulus) * stretch
        + f64::from(sponge.shear_modulus) * shear
        + f64::from(sponge.volume_modulus) * (ratio - 1.0).powi(2))
}

fn vector(row: &[f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[WETNESS]), f64::from(row[1]), f64::from(row[2]))
}
