//! What a host may look at: read-only views of a world.

use sorb_kernels::{
    body::Body,
    columns::{Columns, lane},
    cpu::Cpu,
    params::Params,
    sph,
};

use super::World;
use crate::{
    clock::Clock,
    digest,
    measure::Measures,
    rigid::RigidEngine,
    scene::Scene,
    schedule::{PhaseTime, Plan},
    sponge::Lattice,
};

impl World {
    /// The scene that the world was built from.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What runs in a step, and what is skipped and why.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        self.plans.whole()
    }

    /// What runs in the next step: [`Self::plan`] without what has nothing to do as long as parts are asleep.
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

    /// Parameters of the last step.
    #[must_use]
    pub fn params(&self) -> &Params {
        &self.params
    }

    /// All columns, read only. Rows of the fluid change their order from step to step.
    ///
    /// On a GPU this reads back the state and what measures need (density, interior, saturation), once after every step
    /// or frame that is looked at; other scratch columns are not kept.
    #[must_use]
    pub fn columns(&self) -> &Columns {
        self.stores.view()
    }

    /// Positions of the particles \[m\], in the order of their cells; w: pressure over squared density.
    #[must_use]
    pub fn particle_positions(&self) -> &[[f32; 4]] {
        &self.columns().fluid.position[..self.stores.host.rows.fluid]
    }

    /// Velocities of the particles \[m/s\]; w: volume \[m^3\].
    #[must_use]
    pub fn particle_velocities(&self) -> &[[f32; 4]] {
        &self.columns().fluid.velocity[..self.stores.host.rows.fluid]
    }

    /// Pressures of the particles as the last step found them \[Pa\], in the order of the positions; zero at time zero.
    ///
    /// With `wcsph` that of the equation of state. The solve of `dfsph` knows multipliers; what is given here is the stress
    /// that pairs of neighbours carry by them where water fills the space, see
    /// [`pressure_moments`](sorb_kernels::sph::obstacles::pressure_moments). Inside sponges neighbours fill the pores alone: the pressure
    /// in the pores is this times the porosity, `1 - (1 - phi) / J` where the sponge has J of its volume at rest.
    #[must_use]
    pub fn particle_pressures(&self) -> Vec<f32> {
        let (fluid, count) = (&self.columns().fluid, self.stores.host.rows.fluid);
        let parameters = &self.params.fluid;
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
        // Of a particle of a lattice beside a wall, half a spacing away.
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

    /// Identities of the particles: `ids[row]` is the same particle for ever.
    #[must_use]
    pub fn particle_ids(&self) -> &[u32] {
        &self.columns().fluid.id[..self.stores.host.rows.fluid]
    }

    /// Positions of the sponge nodes \[m\], of all sponges; w: inverse mass \[1/kg\].
    #[must_use]
    pub fn node_positions(&self) -> &[[f32; 4]] {
        &self.columns().nodes.position[..self.stores.host.rows.nodes]
    }

    /// Velocities of the sponge nodes \[m/s\].
    #[must_use]
    pub fn node_velocities(&self) -> &[[f32; 4]] {
        &self.columns().nodes.velocity[..self.stores.host.rows.nodes]
    }

    /// Saturation of the sponge nodes \[1\], about 0 to 1; empty without fluid.
    #[must_use]
    pub fn node_saturations(&self) -> &[f32] {
        let saturation = &self.columns().nodes.saturation;
        &saturation[..saturation.len().min(self.stores.host.rows.nodes)]
    }

    /// The lattice: tets, outer surface, which node belongs to which sponge.
    #[must_use]
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Shapes and poses of the bodies, in the order of the scene.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.stores.host.bodies.states.0
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

    /// Digest of the state: equal digests mean equal bits, whatever the machine, threads and SIMD level.
    #[must_use]
    pub fn digest(&self) -> u64 {
        digest::digest(self.columns(), &self.clock, &self.sleep.dormant())
    }
}
