//! Fluid and sponge, particle by node.

use glam::DVec3;

use super::{gradient, grid, keep, row, smoothing, vector, vectors, wetting};
use crate::{
    column::FAR_ROW,
    columns::{Columns, lane},
    cpu::CHUNK,
    grid::neighbors::{ListValues, Neighbors},
    lanes::LANES,
    params::{Params, SpongeParams},
};

/// Particles, controls and the weights between them.
pub(super) struct Pairs {
    pub(super) particles: Vec<DVec3>,
    pub(super) controls: Vec<DVec3>,
    volume: Vec<f64>,
    radius: f32,
}

impl Pairs {
    pub(super) fn new(params: &Params, columns: &Columns) -> Self {
        let controls = &columns.controls.position;
        Self {
            particles: vectors(&columns.fluid.position, columns.rows.fluid),
            controls: vectors(controls, columns.rows.nodes),
            volume: controls.iter().map(|row| f64::from(row[lane::controls::position::VOLUME])).collect(),
            radius: params.coupling.support_radius,
        }
    }

    /// `V_a W_ia`.
    pub(super) fn weight(&self, particle: usize, control: usize) -> f64 {
        let distance = self.particles[particle].distance(self.controls[control]);
        self.volume[control] * smoothing(self.radius, distance)
    }

    /// Whether one is in the list of the other.
    pub(super) fn are_near(&self, particle: usize, control: usize) -> bool {
        self.particles[particle].distance(self.controls[control]) < f64::from(self.radius)
    }

    /// Gradient of `W_ia` at the particle.
    fn gradient(&self, particle: usize, control: usize) -> DVec3 {
        gradient(self.radius, self.particles[particle] - self.controls[control])
    }
}

/// Values for the entries of lists, one for every pair; the lists themselves are kept.
fn list_values(
    lists: &Neighbors,
    (queries, targets): (usize, usize),
    value: impl Fn(usize, usize) -> f64,
) -> ListValues {
    let mut values = ListValues::default();
    values.match_lists(lists);
    for query in 0..queries {
        let lists = lists.chunk(query);
        let range = lists.range(query % CHUNK);
        let stored = &mut values.0[query / CHUNK][range];
        for (entry, stored) in lists.group(query % CHUNK).iter().zip(stored) {
            let (lane, target) = (query % LANES, entry[query % LANES] as usize);
            stored[lane] = if target < targets { value(query, target) as f32 } else { 0.0 };
        }
    }
    values
}

/// The sponge of a control row.
pub(super) fn sponge<'a>(params: &'a Params, columns: &Columns, control: usize) -> &'a SpongeParams {
    let node = columns.controls.node[control] as usize;
    &params.sponges[columns.nodes.sponge[node] as usize]
}

/// Volume of a particle at rest, `V_0`.
fn rest_volume(params: &Params) -> f64 {
    f64::from(params.fluid.particle_mass) / f64::from(params.fluid.rest_density)
}

/// Any order of the controls is valid: here that of the nodes.
pub(crate) fn controls(params: &Params, columns: &mut Columns) {
    let rows = columns.rows;
    let (nodes, controls) = (&columns.nodes, &mut columns.controls);
    controls.node = (0..rows.nodes as u32).collect();
    controls.cells.order.clone_from(&controls.node);
    controls.position = vec![FAR_ROW; nodes.position.len()];
    for node in 0..rows.nodes {
        let size = wetting::size(&params.sponges[nodes.sponge[node] as usize], nodes, node);
        let volume = f64::from(nodes.volume[node]) * size.powi(3);
        controls.position[node] = row(vector(nodes.position[node]), volume);
    }
    let pairs = Pairs::new(params, columns);
    let (fluid, nodes) = (columns.fluid.position.len(), columns.nodes.position.len());
    columns.fluid.controls = grid::lists(params, &pairs.particles, &pairs.controls, fluid, pairs.radius);
    columns.controls.fluid = grid::lists(params, &pairs.controls, &pairs.particles, nodes, pairs.radius);
}

pub(crate) fn saturation(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    let rows = columns.controls.position.len();
    let counts = (columns.rows.nodes, columns.rows.fluid);
    columns.controls.fluid_weights =
        list_values(&columns.controls.fluid, counts, |control, particle| pairs.weight(particle, control));
    columns.controls.saturation = vec![0.0; rows];
    columns.controls.suction = vec![0.0; rows];
    columns.nodes.saturation = vec![0.0; columns.nodes.position.len()];
    for control in 0..columns.rows.nodes {
        let node = columns.controls.node[control] as usize;
        let sponge = sponge(params, columns, control);
        let distance = |x: &DVec3| x.distance(pairs.controls[control]);
        let sum: f64 = pairs.particles.iter().map(|x| smoothing(pairs.radius, distance(x))).sum();
        let pores = f64::from(sponge.porosity) * f64::from(columns.nodes.interior[node]);
        let saturation = rest_volume(params) * sum / pores;
        let dry = (1.0 - saturation).max(0.0);
        let pressure = -f64::from(sponge.entry_pressure) * (1.0 + f64::from(sponge.saturation_gain) * dry);
        let suction = f64::from(columns.nodes.suction[node]) * pressure * pairs.volume[control];
        columns.controls.saturation[control] = saturation as f32;
        columns.nodes.saturation[node] = saturation as f32;
        columns.controls.suction[control] = suction as f32;
    }
}

pub(crate) fn interior(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    let counts = (columns.rows.fluid, columns.rows.nodes);
    columns.fluid.control_weights =
        list_values(&columns.fluid.controls, counts, |particle, control| pairs.weight(particle, control));
    columns.fluid.interior = vec![0.0; columns.fluid.position.len()];
    columns.fluid.drag_rate = vec![[0.0; 4]; columns.fluid.position.len()];
    for particle in 0..columns.rows.fluid {
        let (mut chi, mut linear, mut inertial, mut mobile, mut follows) = (0.0, 0.0, 0.0, 0.0, 0.0);
        let mut inside = 0.0;
        for control in 0..columns.rows.nodes {
            let weight = pairs.weight(particle, control);
            chi += weight;
            let node = columns.controls.node[control] as usize;
            let pores = columns.nodes.pores[node];
            let [volume_ratio, drag_rate, inertial_drag_rate, porosity] = pores.map(f64::from);
            inside += weight * volume_ratio;
            follows += weight * volume_ratio * (0.7 * (1.0 - porosity) / porosity).min(1.0).sqrt();
            linear += weight * drag_rate;
            inertial += weight * inertial_drag_rate;
            mobile += weight
                * columns
                    .nodes
                    .wetting
                    .get(node)
                    .map_or(1.0, |row| f64::from(row[lane::nodes::wetting::MOBILITY]));
        }
        let slower = if mobile > 0.0 { chi / mobile } else { 1.0 };
        (linear, inertial) = (linear * slower, inertial * slower.sqrt());
        columns.fluid.interior[particle] = inside as f32;
        columns.fluid.drag_rate[particle] = [linear as f32, inertial as f32, follows as f32, chi as f32];
    }
}

pub(crate) fn suction(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for particle in 0..columns.rows.fluid {
        let mut force = DVec3::ZERO;
        for control in 0..columns.rows.nodes {
            // The column holds V_a p_a.
            let suction = f64::from(columns.controls.suction[control]);
            force -= rest_volume(params) * suction * pairs.gradient(particle, control);
        }
        let old = columns.fluid.acceleration[particle];
        let total = vector(old) + force / f64::from(params.fluid.particle_mass);
        columns.fluid.acceleration[particle] = keep(old, total);
    }
}

pub(crate) fn zero_distance(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for control in 0..columns.rows.nodes {
        let node = columns.controls.node[control] as usize;
        let suction = f64::from(columns.controls.suction[control]);
        let mut force = DVec3::ZERO;
        for particle in 0..columns.rows.fluid {
            // k_ia (x_i - x_a) with the stiffness of the gradient of W.
            force += suction * rest_volume(params) * pairs.gradient(particle, control);
        }
        let reaction = f64::from(sponge(params, columns, control).reaction);
        let inverse_mass = f64::from(columns.nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        let total = vector(columns.nodes.acceleration[node]) + force * reaction * inverse_mass;
        columns.nodes.acceleration[node] = row(total, 0.0);
    }
}

/// 1 / chi, or 0 where there is no drag.
pub(super) fn weight_inside(columns: &Columns, particle: usize) -> f64 {
    let chi = f64::from(columns.fluid.drag_rate[particle][lane::fluid::drag_rate::NODE_WEIGHT]);
    if chi > 1.0e-3 { 1.0 / chi } else { 0.0 }
}

pub(crate) fn control_velocity(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    columns.controls.unfiltered = vec![[0.0; 4]; columns.nodes.position.len()];
    columns.controls.velocity = columns.controls.unfiltered.clone();
    columns.fluid.drag = vec![[0.0; 4]; columns.fluid.position.len()];
    for control in 0..columns.rows.nodes {
        let node = columns.controls.node[control] as usize;
        let (velocity, inverse_mass) = (
            vector(columns.nodes.velocity[node]),
            f64::from(columns.nodes.position[node][lane::nodes::position::INVERSE_MASS]),
        );
        let share = |particle| pairs.weight(particle, control) * weight_inside(columns, particle);
        let shared: f64 = (0..columns.rows.fluid).map(share).sum();
        columns.controls.velocity[control] = row(velocity, shared * inverse_mass);
        columns.controls.unfiltered[control] = row(velocity, inverse_mass);
    }
}

pub(crate) fn drag(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    let mass = f64::from(params.fluid.particle_mass);
    for particle in 0..columns.rows.fluid {
        let inverse = weight_inside(columns, particle);
        let (mut sponge, mut shared) = (DVec3::ZERO, 0.0);
        for control in 0..columns.rows.nodes {
            let weight = pairs.weight(particle, control) * inverse;
            sponge += weight * vector(columns.controls.velocity[control]);
            shared +=
                weight * f64::from(columns.controls.velocity[control][lane::controls::velocity::DRAG_SHARE]);
        }
        let rate = f64::from(params.step)
            * f64::from(columns.fluid.drag_rate[particle][lane::fluid::drag_rate::DRAG_RATE]);
        let strength = mass * rate / (1.0 + rate);
        // The column holds J_i over the sum of weights.
        let old = vector(columns.fluid.drag[particle]);
        let wanted = strength * inverse * (vector(columns.fluid.velocity[particle]) - sponge);
        columns.fluid.drag[particle] = row(old + (wanted - old) / (1.0 + strength * shared), 0.0);
    }
}

/// Sum over the particles of `w_ia J_i`.
fn received(pairs: &Pairs, columns: &Columns, control: usize) -> DVec3 {
    let part = |particle| pairs.weight(particle, control) * vector(columns.fluid.drag[particle]);
    (0..columns.rows.fluid).map(part).sum()
}

pub(crate) fn velocity_filter(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for control in 0..columns.rows.nodes {
        let old = columns.controls.unfiltered[control];
        let new = vector(old)
            + received(&pairs, columns, control) * f64::from(old[lane::controls::unfiltered::INVERSE_MASS]);
        columns.controls.velocity[control] = keep(columns.controls.velocity[control], new);
    }
}

pub(crate) fn exchange(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for control in 0..columns.rows.nodes {
        let impulse = received(&pairs, columns, control);
        let old = columns.controls.unfiltered[control];
        let new = vector(old) + impulse * f64::from(old[lane::controls::unfiltered::INVERSE_MASS]);
        columns.controls.velocity[control] = keep(old, new);
        let node = columns.controls.node[control] as usize;
        columns.nodes.velocity[node] = keep(columns.nodes.velocity[node], new);
    }
}

pub(crate) fn drag_kick(params: &Params, columns: &mut Columns) {
    for particle in 0..columns.rows.fluid {
        let chi = f64::from(columns.fluid.drag_rate[particle][lane::fluid::drag_rate::NODE_WEIGHT]);
        let lost = chi * vector(columns.fluid.drag[particle]) / f64::from(params.fluid.particle_mass);
        let old = columns.fluid.velocity[particle];
        columns.fluid.velocity[particle] = keep(old, vector(old) - lost);
    }
}
