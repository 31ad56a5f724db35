//! Read-only views of a world for hosts.

use sorb_kernels::{
    body::Body,
    columns::{Columns, lane},
    cpu::Cpu,
    sph,
};

use super::{BodyLoads, World};
use crate::{
    clock::Clock,
    digest,
    measure::Measures,
    rigid::RigidEngine,
    scene::Scene,
    schedule::{PhaseTime, Plan},
    sponge::Lattice,
    water::ranks,
};

/// Views of a state, row by row.
macro_rules! views {
    ($State:ty) => {
        impl $State {
            /// Positions of the particles \[m\]: x, y, z, and a fourth number that is internal. Rows change their order from
            /// step to step; [`Self::particle_ids`] identifies them.
            #[must_use]
            pub fn particle_positions(&self) -> &[[f32; 4]] {
                let columns = self.columns();
                &columns.fluid.position[..columns.rows.fluid]
            }

            /// Velocities of the particles \[m/s\]: x, y, z, and a fourth number that is internal.
            #[must_use]
            pub fn particle_velocities(&self) -> &[[f32; 4]] {
                let columns = self.columns();
                &columns.fluid.velocity[..columns.rows.fluid]
            }

            /// Identities of the particles: `ids[row]` is the same particle for ever. Those of the scene are 0 to their number less one;
            /// poured ones have the next numbers, and no number is given twice.
            #[must_use]
            pub fn particle_ids(&self) -> &[u32] {
                let columns = self.columns();
                &columns.fluid.id[..columns.rows.fluid]
            }

            /// Share of each particle that sponges hold \[1\], 0 outside and about 1 inside; empty without sponges.
            #[must_use]
            pub fn particle_interiors(&self) -> &[f32] {
                let columns = self.columns();
                let interior = &columns.fluid.interior;
                &interior[..interior.len().min(columns.rows.fluid)]
            }

            /// Positions of the sponge nodes \[m\], of all sponges: x, y, z, and the inverse mass \[1/kg\], 0 for nodes that a body holds.
            /// Rows keep their order, that of the lattice.
            #[must_use]
            pub fn node_positions(&self) -> &[[f32; 4]] {
                let columns = self.columns();
                &columns.nodes.position[..columns.rows.nodes]
            }

            /// Velocities of the sponge nodes \[m/s\]: x, y, z, and a fourth number that is internal.
            #[must_use]
            pub fn node_velocities(&self) -> &[[f32; 4]] {
                let columns = self.columns();
                &columns.nodes.velocity[..columns.rows.nodes]
            }

            /// Saturation of the sponge nodes \[1\], about 0 to 1; empty without fluid.
            #[must_use]
            pub fn node_saturations(&self) -> &[f32] {
                let columns = self.columns();
                let saturation = &columns.nodes.saturation;
                &saturation[..saturation.len().min(columns.rows.nodes)]
            }
        }
    };
}
views!(World);
#[cfg(feature = "gpu")]
views!(crate::gpu::State);

impl World {
    /// The scene that the world was built from, with what commands have changed of it.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The phases of a step, with the skipped ones and the reason: of `internal`, without any promise.
    #[doc(hidden)]
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.plans.whole()
    }

    /// The phases of the next step: [`Self::plan`] without those that have no work while parts sleep.
    #[doc(hidden)]
    #[must_use]
    pub fn step_plan(&self) -> &Plan {
        self.plans.of(self.awake())
    }

    /// Time spent in every phase that runs.
    #[must_use]
    pub fn phase_times(&self) -> &[PhaseTime] {
        self.runner.times()
    }

    /// Time spent in whole steps.
    #[must_use]
    pub fn step_time(&self) -> &PhaseTime {
        self.runner.step_time()
    }

    /// Threads and SIMD level.
    #[must_use]
    pub fn cpu(&self) -> &Cpu {
        &self.cpu
    }

    /// Simulated time, steps and frames.
    #[must_use]
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    /// All columns, read only.
    pub(crate) fn columns(&self) -> &Columns {
        self.stores.view()
    }

    /// Number of particles; on a GPU without reading anything back.
    #[must_use]
    pub fn particle_count(&self) -> usize {
        self.stores.host.rows.fluid
    }

    /// Pressures of the particles in the last step \[Pa\], in the order of the positions; zero at time zero.
    ///
    /// With `wcsph` that of the equation of state, with `divergence` that of the solve. The solve of `dfsph` computes multipliers: the
    /// value here is the stress that pairs of neighbours transmit where water fills the space, see
    /// [`pressure_moments`](sorb_kernels::sph::obstacles::pressure_moments). Inside sponges neighbours fill only the pores. The
    /// pore pressure is this times the porosity with both, `1 - (1 - phi) / J` at a volume ratio J of the sponge.
    #[must_use]
    pub fn particle_pressures(&self) -> Vec<f32> {
        let (fluid, count) = (&self.columns().fluid, self.stores.host.rows.fluid);
        let parameters = &self.params.fluid;
        if parameters.divergence().is_some() {
            let pressure = |row: &[f32; 4]| parameters.rest_density * row[lane::fluid::velocity::PRESSURE];
            return fluid.velocity.iter().take(count).map(pressure).collect();
        }
        let Some(solve) = &parameters.incompressible else {
            let rows = fluid.position.iter().zip(&fluid.density).take(count);
            let mut pressures: Vec<_> = rows
                .map(|(row, density)| {
                    row[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY] * density * density
                })
                .collect();
            pressures.resize(count, 0.0);
            return pressures;
        };
        let (inside, beside) = sph::obstacles::pressure_moments(&parameters.smoothing, parameters.spacing);
        // For the first layer of a lattice beside a wall, half a spacing away.
        let range = solve.boundary_range;
        let whole = solve.boundary_share * (1.0 - 0.5 * parameters.spacing / range).powi(6);
        let square = parameters.rest_density * parameters.rest_density;
        let (inside, lack) = ((inside as f32) * square, ((inside - beside) as f32) * square);
        let shares = sph::boundary::shares(&self.cpu, &self.params, self.columns());
        let rows = fluid.position.iter().zip(&shares).take(count);
        rows.map(|(row, share)| {
            row[lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY]
                * (inside - lack * (share[lane::fluid::boundary::SHARE] / whole).min(2.0))
        })
        .collect()
    }

    /// Densities of the particles by summation \[kg/m^3\], in the order of the positions. Near walls, bodies and the surface
    /// they lack the volume that is no water. They are summed anew at every call: a step of `dfsph` needs none.
    #[must_use]
    pub fn particle_densities(&self) -> Vec<f32> {
        if self.particle_ids().is_empty() {
            return Vec::new();
        }
        let summed = self.summed_density();
        let count = summed.rows.fluid;
        let mut by_rank = vec![0.0; count];
        let ids = summed.fluid.id.get(..count).unwrap_or_default();
        for (rank, density) in ranks(ids).into_iter().zip(&summed.fluid.density) {
            if let Some(own) = by_rank.get_mut(rank as usize) {
                *own = *density;
            }
        }
        let own = ranks(self.particle_ids()).into_iter();
        own.map(|rank| by_rank.get(rank as usize).copied().unwrap_or(0.0)).collect()
    }

    /// Mass of every particle \[kg\]; 0 without fluid.
    #[must_use]
    pub fn particle_mass(&self) -> f32 {
        self.params.fluid.particle_mass
    }

    /// Masses of the dry nodes \[kg\], in the order of the positions, held nodes included.
    #[must_use]
    pub fn node_masses(&self) -> Vec<f32> {
        let Lattice { node_volume, node_sponge, .. } = &self.lattice;
        let density = |sponge: u32| self.scene.sponges[sponge as usize].density;
        node_volume.iter().zip(node_sponge).map(|(volume, sponge)| volume * density(*sponge)).collect()
    }

    /// The lattice: tets, outer surface, and the sponge of each node.
    #[must_use]
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Shapes, poses and velocities of the bodies, in the order of the scene.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.stores.host.bodies.states.0
    }

    /// Force of the fluid on every body \[N\], in the order of the scene: the mean over the steps since the last frame began.
    /// Empty before the first step, and without bodies.
    ///
    /// On a GPU, bodies that never move are told of the last step of a frame only.
    #[must_use]
    pub fn body_fluid_forces(&self) -> Vec<glam::DVec3> {
        self.loads.means().into_iter().map(|loads| loads.fluid.force).collect()
    }

    /// Forces and torques on every body by their source, in the order of the scene: means over the steps since the last frame began.
    /// Empty before the first step, and without bodies. On a GPU as [`Self::body_fluid_forces`].
    #[must_use]
    pub fn body_loads(&self) -> Vec<BodyLoads> {
        self.loads.means()
    }

    /// The engine that moves the bodies.
    #[must_use]
    pub fn rigid_engine(&self) -> &dyn RigidEngine {
        &*self.engine
    }

    /// Masses, momenta, energies and errors of the present state.
    #[must_use]
    pub fn measures(&self) -> Measures {
        Measures::of(self)
    }

    /// Digest of the state columns, the clock and what sleeps. A part of [`Self::digest`], without the contacts of bodies, and
    /// the one in the snapshots of this project. Equal digests may diverge later.
    #[must_use]
    pub fn state_digest(&self) -> u64 {
        digest::digest(self.columns(), &self.clock, &self.sleep.dormant())
    }
}
