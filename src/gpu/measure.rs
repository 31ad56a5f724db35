//! Measures of a state on a device, from sums that it computes.

use sorb_kernels::gpu::{FluidSums, NodeSums, Sums};

use super::Device;
use crate::{Measures, World};

impl Device {
    /// Adds sums over the state to measures; false if the device cannot provide them, or the host has the state.
    pub(crate) fn add_sums(&self, world: &World, measures: &mut Measures) -> bool {
        // With a pressure solve the measured density is summed anew.
        if self.is_host_current() || world.params.fluid.incompressible.is_some() {
            return false;
        }
        let lattice = world.lattice();
        let mass = |(volume, sponge): (&f32, &u32)| volume * world.scene.sponges[*sponge as usize].density;
        let masses: Vec<f32> = lattice.node_volume.iter().zip(&lattice.node_sponge).map(mass).collect();
        // A failure here occurs in the next step as well; until then the state that was read back before is used.
        let Some(sums) = self.resident().and_then(|resident| resident.sums(&masses).ok()) else {
            return false;
        };
        measures.add(world, &sums);
        true
    }
}

impl Measures {
    fn add(&mut self, world: &World, sums: &Sums) {
        if let Some(fluid) = &sums.fluid {
            self.add_fluid_sums(world, fluid);
        }
        if let Some(nodes) = &sums.nodes {
            self.add_node_sums(world, nodes);
        }
        if let Some(tets) = &sums.tets {
            self.sponge_volume = tets.volume;
            self.elastic_energy = tets.energy;
        }
    }

    fn add_fluid_sums(&mut self, world: &World, sums: &FluidSums) {
        let mass = f64::from(world.params.fluid.particle_mass);
        let count = world.stores.host.rows.fluid as f64;
        self.water_mass = mass * count;
        self.absorbed_mass = mass * sums.inside;
        self.linear_momentum += sums.velocity * mass;
        self.angular_momentum += sums.angular * mass;
        self.kinetic_energy += 0.5 * mass * sums.speed_squared;
        self.potential_energy -= mass * world.params.gravity.as_dvec3().dot(sums.position);
        self.mean_density_error = sums.density_error / count;
        self.maximum_density_error = sums.largest_density_error;
        self.maximum_speed = self.maximum_speed.max(sums.largest_speed_squared.sqrt());
    }

    fn add_node_sums(&mut self, world: &World, sums: &NodeSums) {
        self.linear_momentum += sums.momentum;
        self.angular_momentum += sums.angular;
        self.kinetic_energy += 0.5 * sums.speed_squared;
        self.potential_energy -= world.params.gravity.as_dvec3().dot(sums.position);
        self.sponge_centre = sums.position / sums.mass;
        if sums.volume > 0.0 {
            self.saturation = sums.saturation / sums.volume;
        }
        let highest = sums.highest_wet.unwrap_or(0.0).max(0.0);
        self.wicking_height = (highest - sums.lowest).max(0.0);
        self.maximum_speed = self.maximum_speed.max(sums.largest_speed_squared.sqrt());
    }
}
