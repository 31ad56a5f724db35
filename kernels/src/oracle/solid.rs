//! The material of sponges in the pressure solve for the divergence, particle by node.

use glam::{DMat3, DVec3};

use super::{
    couple::{Pairs, sponge, weight_inside},
    divergence::{outer, renormalisation},
    gradient, keep, row, smoothing, vector, wetting,
};
use crate::{
    columns::{Columns, lane},
    params::Params,
};

/// Support radius of the material.
fn radius(params: &Params) -> f32 {
    params.solid.map_or(1.0, |solid| solid.support_radius)
}

/// A node and its images in walls: places, and signs of directions along the axes.
fn seen(params: &Params, node: DVec3) -> Vec<(DVec3, DVec3)> {
    let mut all = vec![(node, DVec3::ONE)];
    let Some((low, high)) = params.walls else { return all };
    for axis in 0..3 {
        for wall in [f64::from(low[axis]), f64::from(high[axis])] {
            for (place, signs) in all.clone() {
                // Each axis is mirrored once.
                if signs[axis] > 0.0 {
                    let (mut place, mut signs) = (place, signs);
                    place[axis] = 2.0 * wall - place[axis];
                    signs[axis] = -1.0;
                    all.push((place, signs));
                }
            }
        }
    }
    all
}

/// `-dW/dr / r`.
fn factor(params: &Params, offset: DVec3) -> f64 {
    let unit = offset.normalize_or_zero();
    if unit == DVec3::ZERO { 0.0 } else { -gradient(radius(params), offset).dot(unit) / offset.length() }
}

/// Everything that a particle sees of the material: which control, the offset to it, `c_ia`, signs, and `V_s W`.
pub(super) fn around(
    params: &Params,
    columns: &Columns,
    pairs: &Pairs,
    particle: usize,
) -> Vec<(usize, DVec3, f64, DVec3, f64)> {
    let mut all = Vec::new();
    for control in (0..columns.rows.nodes).filter(|control| pairs.are_near(particle, *control)) {
        let volume = f64::from(columns.controls.material[control][lane::controls::material::VOLUME]);
        for (place, signs) in seen(params, pairs.controls[control]) {
            let offset = place - pairs.particles[particle];
            let share = volume * smoothing(radius(params), offset.length());
            all.push((control, offset, volume * factor(params, offset), signs, share));
        }
    }
    all
}

/// First moments of the material around every particle; none without porous sponges.
pub(super) fn first_moments(params: &Params, columns: &Columns) -> Vec<DVec3> {
    if params.solid.is_none() || columns.rows.nodes == 0 {
        return vec![DVec3::ZERO; columns.rows.fluid];
    }
    let pairs = Pairs::new(params, columns);
    let of = |particle: usize| -> DVec3 {
        around(params, columns, &pairs, particle).iter().map(|(_, offset, c, ..)| *c * *offset).sum()
    };
    (0..columns.rows.fluid).map(of).collect()
}

pub(crate) fn expect(params: &Params, columns: &mut Columns) {
    let h = f64::from(params.step);
    columns.controls.material = vec![[0.0; 4]; columns.nodes.position.len()];
    columns.controls.expected = columns.controls.material.clone();
    for control in 0..columns.rows.nodes {
        let (nodes, node) = (&columns.nodes, columns.controls.node[control] as usize);
        let v = nodes.velocity[node];
        let solid = 1.0 - f64::from(sponge(params, columns, control).porosity);
        columns.controls.material[control] = row(vector(v), solid * f64::from(nodes.volume[node]));
        let inverse_mass = f64::from(nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        let Some(driven) = nodes.driven.get(node).filter(|row| row[lane::nodes::driven::STEP] > 0.0) else {
            continue;
        };
        if inverse_mass > 0.0 {
            let rate = (vector(v) - vector(*driven)) / f64::from(driven[lane::nodes::driven::STEP]);
            columns.controls.expected[control] = row(h * rate / inverse_mass, 0.0);
        }
    }
}

/// `sum_a w_ia` of a row of every control.
fn at_particle(columns: &Columns, pairs: &Pairs, particle: usize, rows: &[[f32; 4]]) -> DVec3 {
    let part = |control: usize| pairs.weight(particle, control) * vector(rows[control]);
    weight_inside(columns, particle) * (0..columns.rows.nodes).map(part).sum::<DVec3>()
}

pub(crate) fn moments(params: &Params, columns: &mut Columns) {
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    let pairs = Pairs::new(params, columns);
    let (particles, controls) = (columns.rows.fluid, columns.rows.nodes);
    let rows = columns.fluid.position.len();
    let none = vec![[0.0; 4]; rows];
    for particle in 0..particles {
        let u = at_particle(columns, &pairs, particle, &columns.controls.material);
        let [linear, inertial, ..] = columns.fluid.drag_rate[particle].map(f64::from);
        let speed = (vector(columns.fluid.velocity[particle]) - u).length();
        let inverse = weight_inside(columns, particle);
        let rate = if inverse > 0.0 { h * (linear + inertial * speed) } else { 0.0 };
        columns.fluid.mobility.resize(rows, [0.0; 4]);
        columns.fluid.mobility[particle] = row(DVec3::X / (1.0 + rate), 0.0);
        columns.fluid.held.resize(rows, [0.0; 4]);
        columns.fluid.held[particle] = row(DVec3::ZERO, mass * rate / (1.0 + rate) * inverse);
    }
    columns.controls.compliance = vec![[0.0; 4]; columns.nodes.position.len()];
    for control in 0..controls {
        let held = |particle: usize| {
            pairs.weight(particle, control) * f64::from(columns.fluid.held[particle][lane::fluid::held::MASS])
        };
        let drawn: f64 = (0..particles).map(held).sum();
        let response = response_of(params, columns, control, drawn);
        let solid = columns.controls.material[control][lane::controls::material::VOLUME];
        columns.controls.compliance[control] =
            row(DVec3::new(response, drawn * response, 0.0), f64::from(solid));
    }
    let fluid = &mut columns.fluid;
    for column in [&mut fluid.moment, &mut fluid.renormalisation, &mut fluid.renormalisation_between] {
        column.clone_from(&none);
    }
    for particle in 0..particles {
        material_moments(params, columns, &pairs, particle);
        let push = |(control, offset, c, ..): &(usize, DVec3, f64, DVec3, f64)| {
            let compliance = columns.controls.compliance[*control][lane::controls::compliance::COMPLIANCE];
            (*c * *offset).length_squared() * f64::from(compliance)
        };
        let direct: f64 = around(params, columns, &pairs, particle).iter().map(push).sum();
        let drawn = |control: usize| {
            pairs.weight(particle, control)
                * f64::from(columns.controls.compliance[control][lane::controls::compliance::DRAWN])
        };
        let follows = (0..controls).map(drawn).sum::<f64>() * weight_inside(columns, particle);
        let fluid = &mut columns.fluid;
        let own = f64::from(fluid.mobility[particle][lane::fluid::mobility::MOBILITY]);
        fluid.mobility[particle] =
            row(DVec3::new(own, own + (1.0 - own) * follows, mass / 3.0 * direct), 0.0);
    }
}

/// First and second moment of the material around a particle, and its share.
pub(super) fn material_moments(params: &Params, columns: &mut Columns, pairs: &Pairs, particle: usize) {
    let (mut first, mut second, mut share) = (DVec3::ZERO, DMat3::ZERO, 0.0);
    for (_, offset, c, _, shape) in around(params, columns, pairs, particle) {
        first += c * offset;
        second += outer(offset, offset) * c;
        share += shape;
    }
    let fluid = &mut columns.fluid;
    fluid.moment[particle] = row(first, share);
    let along = DVec3::new(second.x_axis.x, second.y_axis.y, second.z_axis.z);
    let between = DVec3::new(second.y_axis.z, second.z_axis.x, second.x_axis.y);
    (fluid.renormalisation[particle], fluid.renormalisation_between[particle]) =
        (row(along, 0.0), row(between, 0.0));
}

/// What a node responds to impulses with.
pub(super) fn response_of(params: &Params, columns: &Columns, control: usize, drawn: f64) -> f64 {
    let h = f64::from(params.step);
    let own = sponge(params, columns, control);
    let node = columns.controls.node[control] as usize;
    let softer = 1.0 - f64::from(own.wetting.softening) * wetting::wetness(&columns.nodes, node);
    let modulus = softer * (f64::from(own.mu) + f64::from(own.lambda) / 3.0);
    let volume = f64::from(columns.controls.position[control][lane::controls::position::VOLUME]);
    let stiffness = 8.0 * volume / f64::from(own.edge).powi(2) * modulus;
    let elastic = 0.25 * h * (h + f64::from(own.damping)) * stiffness;
    let inverse_mass = f64::from(columns.nodes.position[node][lane::nodes::position::INVERSE_MASS]);
    if inverse_mass > 0.0 { 1.0 / (1.0 / inverse_mass + drawn + elastic) } else { 0.0 }
}

pub(crate) fn diagonal(params: &Params, columns: &mut Columns) {
    let fluid = &mut columns.fluid;
    for particle in 0..columns.rows.fluid {
        let norm: f64 = renormalisation(fluid, particle).to_cols_array().iter().map(|x| x * x).sum();
        let [_, with_nodes, of_nodes, _] = fluid.mobility[particle].map(f64::from);
        let diagonal = &mut fluid.pressure_rows[particle][lane::fluid::pressure_rows::DIAGONAL];
        *diagonal =
            (with_nodes * f64::from(*diagonal) + f64::from(params.step).powi(2) * of_nodes * norm) as f32;
    }
}

pub(crate) fn response(params: &Params, columns: &mut Columns) {
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    let pairs = Pairs::new(params, columns);
    let fluid = &mut columns.fluid;
    fluid.undragged.clone_from(&fluid.correction);
    for particle in 0..columns.rows.fluid {
        let change = vector(fluid.correction[particle]) - vector(fluid.velocity[particle]);
        let held = fluid.held[particle];
        fluid.held[particle] = keep(held, f64::from(held[lane::fluid::held::MASS]) * change);
    }
    let rows = columns.nodes.position.len();
    let mut forces = vec![DVec3::ZERO; rows];
    for particle in 0..columns.rows.fluid {
        let pressure = f64::from(columns.fluid.predicted[particle][lane::fluid::predicted::PRESSURE]);
        let own = renormalisation(&columns.fluid, particle);
        for (control, offset, c, signs, _) in around(params, columns, &pairs, particle) {
            forces[control] += signs * (own * offset * (mass * pressure * c));
        }
    }
    let controls = &mut columns.controls;
    for column in [&mut controls.force, &mut controls.impulse, &mut controls.solved] {
        column.resize(rows, [0.0; 4]);
    }
    for (control, force) in forces.iter().enumerate().take(columns.rows.nodes) {
        let held = |particle: usize| pairs.weight(particle, control) * vector(columns.fluid.held[particle]);
        let drawn: DVec3 = (0..columns.rows.fluid).map(held).sum();
        let received = h * *force + drawn;
        let expected = vector(controls.expected[control]);
        let [compliance, _, _, volume] = controls.compliance[control].map(f64::from);
        let velocity = vector(controls.material[control]) + compliance * (received + expected);
        controls.force[control] = row(*force, 0.0);
        controls.impulse[control] = row(received, 0.0);
        controls.solved[control] = row(velocity, volume);
    }
}

pub(crate) fn velocity(params: &Params, columns: &mut Columns) {
    let pairs = Pairs::new(params, columns);
    for particle in 0..columns.rows.fluid {
        let own = f64::from(columns.fluid.mobility[particle][lane::fluid::mobility::MOBILITY]);
        let u = at_particle(columns, &pairs, particle, &columns.controls.solved);
        let w = own * vector(columns.fluid.correction[particle]) + (1.0 - own) * u;
        let inverse = renormalisation(&columns.fluid, particle);
        let material = around(params, columns, &pairs, particle);
        let flux = |(control, offset, c, signs, _): &(usize, DVec3, f64, DVec3, f64)| {
            let velocity = *signs * vector(columns.controls.solved[*control]);
            *c * (velocity - w).dot(inverse * -*offset)
        };
        columns.fluid.correction[particle] = row(w, material.iter().map(flux).sum());
    }
}

pub(crate) fn kick(params: &Params, columns: &mut Columns) {
    columns.nodes.driven = vec![[0.0; 4]; columns.nodes.position.len()];
    columns.fluid.correction.clone_from(&columns.fluid.undragged);
    for control in 0..columns.rows.nodes {
        let node = columns.controls.node[control] as usize;
        let inverse_mass = f64::from(columns.nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        let gained = inverse_mass * vector(columns.controls.force[control]);
        let old = columns.nodes.acceleration[node];
        columns.nodes.acceleration[node] = keep(old, vector(old) + gained);
        let impulse = inverse_mass * vector(columns.controls.impulse[control]);
        columns.nodes.driven[node] =
            row(vector(columns.nodes.velocity[node]) + impulse, f64::from(params.step));
    }
}
