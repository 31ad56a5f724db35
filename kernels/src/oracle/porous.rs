//! Sponges as porous media, particle by node.

use glam::DVec3;

use super::{
    couple::{Pairs, sponge, weight_inside},
    gradient, keep, row, smoothing, vector, wetting,
};
use crate::{
    columns::{Columns, lane},
    params::Params,
};

/// Support radius of the material volume.
fn solid_radius(params: &Params) -> f32 {
    params.solid.map_or(1.0, |solid| solid.support_radius)
}

pub(crate) fn solid_pressure(params: &Params, columns: &mut Columns) {
    let h = f64::from(params.step);
    columns.controls.solid = vec![[0.0; 4]; columns.nodes.position.len()];
    for control in 0..columns.rows.nodes {
        let (nodes, node) = (&columns.nodes, columns.controls.node[control] as usize);
        let (x, v) = (nodes.position[node], nodes.velocity[node]);
        let share = if x[lane::nodes::position::INVERSE_MASS] > 0.0 {
            f64::from(v[lane::nodes::velocity::FOLLOWED_SHARE])
        } else {
            0.0
        };
        let end = vector(x) + h * vector(v) + h * h * share * vector(nodes.acceleration[node]);
        let solid = 1.0 - f64::from(sponge(params, columns, control).porosity);
        columns.controls.solid[control] = row(end, solid * f64::from(nodes.volume[node]));
    }
    let pairs = Pairs::new(params, columns);
    for particle in 0..columns.rows.fluid {
        let slope: DVec3 = (0..columns.rows.nodes)
            .map(|control| {
                let apart = pairs.particles[particle] - pairs.controls[control];
                f64::from(columns.controls.solid[control][lane::controls::solid::VOLUME])
                    * gradient(solid_radius(params), apart)
            })
            .sum();
        let over_density =
            f64::from(columns.fluid.position[particle][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY])
                * f64::from(params.fluid.rest_density);
        let old = columns.fluid.acceleration[particle];
        columns.fluid.acceleration[particle] = keep(old, vector(old) - over_density * slope);
    }
}

/// Particles that come within reach in the step are missed: lists are those of its beginning.
pub(crate) fn solid_share(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for particle in 0..columns.rows.fluid {
        let old = columns.fluid.boundary[particle];
        let (mut slope, mut share) = (vector(old), f64::from(old[lane::fluid::boundary::SHARE]));
        for control in (0..columns.rows.nodes).filter(|control| pairs.are_near(particle, *control)) {
            let solid = columns.controls.solid[control];
            let apart = vector(columns.fluid.predicted[particle]) - vector(solid);
            slope += f64::from(solid[lane::controls::solid::VOLUME]) * gradient(solid_radius(params), apart);
            share += f64::from(solid[lane::controls::solid::VOLUME])
                * smoothing(solid_radius(params), apart.length());
        }
        columns.fluid.boundary[particle] = row(slope, share);
    }
}

pub(crate) fn solid_reaction(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    let (mass, density) = (f64::from(params.fluid.particle_mass), f64::from(params.fluid.rest_density));
    let Some(solve) = &params.fluid.incompressible else { return };
    let most = f64::from(solve.correction_speed) / f64::from(params.step);
    for control in 0..columns.rows.nodes {
        let solid = columns.controls.solid[control];
        let mut force = DVec3::ZERO;
        for particle in (0..columns.rows.fluid).filter(|particle| pairs.are_near(*particle, control)) {
            let before = pairs.particles[particle] - pairs.controls[control];
            let pressure = f64::from(
                columns.fluid.position[particle][lane::fluid::position::PRESSURE_OVER_SQUARED_DENSITY],
            ) * density;
            force += pressure * gradient(solid_radius(params), before);
            let predicted = columns.fluid.predicted[particle];
            let after = vector(predicted) - vector(solid);
            force += f64::from(predicted[lane::fluid::predicted::PRESSURE_CHANGE])
                * gradient(solid_radius(params), after);
        }
        let node = columns.controls.node[control] as usize;
        let inverse_mass = f64::from(columns.nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        let gained = force * mass * f64::from(solid[lane::controls::solid::VOLUME]) * inverse_mass;
        let old = columns.nodes.acceleration[node];
        columns.nodes.acceleration[node] = keep(old, vector(old) + gained.clamp_length_max(most));
    }
}

pub(super) fn node_velocities(params: &Params, columns: &mut Columns) {
    columns.controls.velocity = vec![[0.0; 4]; columns.nodes.position.len()];
    for control in 0..columns.rows.nodes {
        let node = columns.controls.node[control] as usize;
        let moved = vector(columns.nodes.predicted[node]) - vector(columns.nodes.position[node]);
        columns.controls.velocity[control] = row(moved / f64::from(params.step), 0.0);
    }
}

pub(crate) fn pores(params: &Params, columns: &mut Columns) {
    let nodes = &mut columns.nodes;
    let mut volumes = vec![(0.0, 0.0); nodes.position.len()];
    for (tet, weight) in nodes.topology.tets.iter().zip(&nodes.topology.weights) {
        let weight = f64::from(*weight);
        let [a, b, c, d] = tet.map(|node| vector(nodes.position[node as usize]));
        let volume = (b - a).cross(c - a).dot(d - a) / 6.0;
        for node in tet {
            volumes[*node as usize].0 += weight * volume;
            volumes[*node as usize].1 += weight;
        }
    }
    nodes.pores = vec![[0.0; 4]; nodes.position.len()];
    for (node, (volume, weights)) in volumes.into_iter().enumerate().take(columns.rows.nodes) {
        let sponge = &params.sponges[nodes.sponge[node] as usize];
        let porosity = f64::from(sponge.porosity);
        let rest = f64::from(sponge.edge).powi(3) / 12.0;
        let minimum = (1.0 - porosity) / (1.0 - porosity.min(0.15));
        let ratio = if sponge.pores_close { (volume / weights / rest).clamp(minimum, 10.0) } else { 1.0 };
        let now = 1.0 - (1.0 - porosity) / ratio;
        // K / K_0.
        let permeability = (now / porosity).powi(3) * ((1.0 - porosity) / (1.0 - now)).powi(2);
        let linear = f64::from(sponge.drag_rate) * (now / porosity) / permeability;
        let inertial = f64::from(sponge.inertial_drag_rate) * (now / porosity).powi(2) / permeability.sqrt();
        let ratio = ratio / wetting::size(sponge, nodes, node).powi(3);
        nodes.pores[node] = [ratio, linear * ratio, inertial * ratio, now].map(|value| value as f32);
    }
}

pub(crate) fn drag_impulse(params: &Params, columns: &mut Columns) {
    node_velocities(params, columns);
    let pairs = Pairs::new(params, columns);
    columns.fluid.drag = vec![[0.0; 4]; columns.fluid.position.len()];
    for particle in 0..columns.rows.fluid {
        let inverse = weight_inside(columns, particle);
        let sponge: DVec3 = (0..columns.rows.nodes)
            .map(|control| {
                pairs.weight(particle, control) * inverse * vector(columns.controls.velocity[control])
            })
            .sum();
        let apart = vector(columns.fluid.velocity[particle]) - sponge;
        let mass = drag_mass(params, columns, particle, apart.length());
        // The column has impulses and masses over the interior value.
        columns.fluid.drag[particle] = row(mass * inverse * apart, mass * inverse);
    }
}

/// Mass that the drag gives to the sponge at this relative speed.
pub(super) fn drag_mass(params: &Params, columns: &Columns, particle: usize, speed: f64) -> f64 {
    let [linear, inertial, ..] = columns.fluid.drag_rate[particle].map(f64::from);
    let h = f64::from(params.step);
    // The speed that the drag leaves, as the root of s (1 + h beta + h gamma s) = |v - u|.
    let (mut low, mut high) = (0.0, speed);
    for _ in 0..80 {
        let middle: f64 = 0.5 * (low + high);
        let is_high = middle * (1.0 + h * (linear + inertial * middle)) > speed;
        (low, high) = if is_high { (low, middle) } else { (middle, high) };
    }
    let rate = h * (linear + inertial * low);
    f64::from(params.fluid.particle_mass) * rate / (1.0 + rate)
}

pub(crate) fn drag_target(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for control in 0..columns.rows.nodes {
        let (mut impulse, mut mass) = (DVec3::ZERO, 0.0);
        for particle in 0..columns.rows.fluid {
            let weight = pairs.weight(particle, control);
            impulse += weight * vector(columns.fluid.drag[particle]);
            mass += weight * f64::from(columns.fluid.drag[particle][lane::fluid::drag::MASS]);
        }
        target_of(params, columns, control, (impulse, mass));
    }
}

/// Target of a node that this impulse acts on, and that moves with this mass.
pub(super) fn target_of(
    params: &Params,
    columns: &mut Columns,
    control: usize,
    (impulse, mass): (DVec3, f64),
) {
    let node = columns.controls.node[control] as usize;
    let free = columns.nodes.free[node];
    let (mut target, mut drawn) = (vector(free), f64::from(free[lane::nodes::free::MASS]));
    if drawn > 0.0 && mass > 1.0e-20 {
        let velocity = vector(columns.controls.velocity[control]) + impulse / mass;
        let by_fluid = vector(columns.controls.position[control]) + f64::from(params.step) * velocity;
        target = (drawn * target + mass * by_fluid) / (drawn + mass);
        drawn += mass;
    }
    columns.nodes.target[node] = row(target, drawn);
}

pub(crate) fn drag_reaction(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    let none = vec![[0.0; 4]; columns.nodes.position.len()];
    (columns.nodes.drag, columns.nodes.drag_moment) = (none.clone(), none);
    for control in 0..columns.rows.nodes {
        let (mut impulse, mut moment, mut mass) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for particle in 0..columns.rows.fluid {
            mass += pairs.weight(particle, control)
                * f64::from(columns.fluid.drag[particle][lane::fluid::drag::MASS]);
            let own = pairs.weight(particle, control) * vector(columns.fluid.drag[particle]);
            impulse += own;
            moment += (pairs.particles[particle] - pairs.controls[control]).cross(own);
        }
        let node = columns.controls.node[control] as usize;
        columns.nodes.drag[node] = row(impulse, mass);
        columns.nodes.drag_moment[node] = row(moment, 0.0);
    }
}

pub(crate) fn drag_settled(params: &Params, columns: &mut Columns) {
    drag_reaction(params, columns);
    for drag in &mut columns.nodes.drag {
        drag[lane::nodes::drag::MASS] = 0.0;
    }
}
