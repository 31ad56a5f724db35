//! What measures sum up, on the device: a few hundred bytes come back instead of the state.

use glam::DVec3;

use super::{
    error::GpuError,
    groups::groups_of,
    layout::Value,
    pack::Summands,
    resident::Resident,
    sum_layout::{GroupSums, NO_VALUE},
    twins::{SUMS, TOTAL},
    vectors::vector,
};

/// Sums over the particles, for a mass of one each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FluidSums {
    /// Sum of the velocities \[m/s\].
    pub velocity: DVec3,
    /// Sum of position x velocity \[m^2/s\].
    pub angular: DVec3,
    /// Sum of squared speeds \[m^2/s^2\].
    pub speed_squared: f64,
    /// Sum of the positions \[m\].
    pub position: DVec3,
    /// Particles whose interior value is above one half.
    pub inside: f64,
    /// Sum of `max(rho / rho_0 - 1, 0)` \[1\].
    pub density_error: f64,
    /// Largest squared speed \[m^2/s^2\].
    pub largest_speed_squared: f64,
    /// Largest `max(rho / rho_0 - 1, 0)` \[1\].
    pub largest_density_error: f64,
}

/// Sums over the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeSums {
    /// Momentum \[kg m/s\].
    pub momentum: DVec3,
    /// Angular momentum about the origin \[kg m^2/s\].
    pub angular: DVec3,
    /// Twice the kinetic energy \[J\].
    pub speed_squared: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Sum of mass times position \[kg m\].
    pub position: DVec3,
    /// Sum of volume times saturation \[m^3\].
    pub saturation: f64,
    /// Volume of nodes that have a saturation \[m^3\].
    pub volume: f64,
    /// Largest squared speed \[m^2/s^2\].
    pub largest_speed_squared: f64,
    /// Height of the highest node that is more than half saturated \[m\], if there is one.
    pub highest_wet: Option<f64>,
    /// Height of the lowest node \[m\].
    pub lowest: f64,
}

/// Sums over the tets.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TetSums {
    /// Volume \[m^3\].
    pub volume: f64,
    /// Energy of the strain, as the solver of the sponge defines it \[J\].
    pub energy: f64,
}

/// Sums over all stores; none for a store without rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Particles.
    pub fluid: Option<FluidSums>,
    /// Nodes.
    pub nodes: Option<NodeSums>,
    /// Tets.
    pub tets: Option<TetSums>,
}

impl Resident {
    /// Sums up the state after a step: in f32, pairwise within groups of 256 rows and then over the groups, always in the
    /// same order. `node_mass` are the masses of the nodes \[kg\].
    ///
    /// # Errors
    /// The device was lost.
    pub fn sums(&self, node_mass: &[f32]) -> Result<Sums, GpuError> {
        let mut parts = Vec::new();
        for (place, pass) in SUMS.iter().enumerate() {
            let mut dispatches = Vec::new();
            dispatches.extend(self.bind_all(&self.jobs("measure", pass), &[])?);
            let groups = groups_of(self.rows_of_sums(place)) as u32;
            let summands = self.uniform("summands", &Summands { groups, place: place as u32 })?;
            let own = [("summands", &summands)];
            dispatches.extend(self.bind_all(&self.jobs("measure", &TOTAL), &own)?);
            parts.push(dispatches);
        }
        self.write("node_mass", bytemuck::cast_slice(node_mass));
        let parts: Vec<_> = parts.iter().map(|part| &part[..]).collect();
        self.submit(&parts, false, None)?;
        let words = self.read(&[("totals", 3 * GroupSums::BYTES)])?.concat();
        let total = |place: usize| GroupSums::take(&words[place * GroupSums::WORDS..][..GroupSums::WORDS]);
        let [fluid, nodes, tets] =
            [0, 1, 2].map(|place| (self.rows_of_sums(place) > 0).then(|| total(place)));
        Ok(Sums { fluid: fluid.map(fluid_sums), nodes: nodes.map(node_sums), tets: tets.map(tet_sums) })
    }

    fn rows_of_sums(&self, place: usize) -> usize {
        [self.rows.fluid, self.rows.nodes, self.rows.tets][place]
    }
}

fn fluid_sums(GroupSums { a, b, c, largest, .. }: GroupSums) -> FluidSums {
    FluidSums {
        velocity: vector(&a),
        speed_squared: a[3].into(),
        angular: vector(&b),
        inside: b[3].into(),
        position: vector(&c),
        density_error: c[3].into(),
        largest_speed_squared: largest[0].into(),
        largest_density_error: largest[1].into(),
    }
}

fn node_sums(GroupSums { a, b, c, d, largest }: GroupSums) -> NodeSums {
    NodeSums {
        momentum: vector(&a),
        speed_squared: a[3].into(),
        angular: vector(&b),
        mass: b[3].into(),
        position: vector(&c),
        saturation: c[3].into(),
        volume: d[0].into(),
        largest_speed_squared: largest[0].into(),
        highest_wet: (largest[1] > NO_VALUE).then_some(largest[1].into()),
        lowest: -f64::from(largest[2]),
    }
}

fn tet_sums(GroupSums { a, .. }: GroupSums) -> TetSums {
    TetSums { volume: a[0].into(), energy: a[1].into() }
}
