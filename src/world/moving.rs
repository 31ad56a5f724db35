//! Speeds of particles, nodes and bodies, and the motion of bodies by the wrenches of fluid and sponges.

use glam::{Mat3, Vec3};
use sorb_kernels::{
    body::{Body, BodyKind, Wrench},
    columns::{BodyStore, Columns},
};

use super::{
    commands::add_forces,
    forces::{Loads, Momentum},
};
use crate::rigid::{LightBodies, RigidEngine, RigidError, check_state};

/// Largest speed of particles or nodes \[m/s\].
pub(super) fn fastest(velocities: &[[f32; 4]]) -> f32 {
    velocities.iter().map(|v| Vec3::new(v[0], v[1], v[2]).length()).fold(0.0, f32::max)
}

/// Largest speed of the surface of a body \[m/s\].
pub(crate) fn fastest_body(bodies: &[Body]) -> f32 {
    bodies.iter().map(Body::fastest).fold(0.0, f32::max)
}

/// Root mean square of the kinematic pressure in a column at rest that is as deep as the fluid \[m^2/s^2\]. It is the estimate of
/// the first step, before any pressure solve.
pub(super) fn column_pressure(positions: &[[f32; 4]], gravity: Vec3) -> f32 {
    let depths = positions.iter().map(|p| gravity.dot(Vec3::new(p[0], p[1], p[2])));
    let (low, high) =
        depths.fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)));
    (high - low).max(0.0) / 3.0_f32.sqrt()
}

/// Wrenches of fluid and sponges on every body in this step.
pub(super) fn wrenches(columns: &Columns) -> Vec<(Wrench, Wrench)> {
    let store = &columns.bodies;
    let count = store.states.0.len();
    let total = |body| (store.fluid_wrenches.total(body, count), store.node_wrenches.total(body, count));
    (0..count).map(total).collect()
}

/// What forces do to the bodies in this step: nothing to those that are held.
pub(crate) fn take_masses(engine: &dyn RigidEngine, bodies: &mut [Body], is_held: impl Fn(usize) -> bool) {
    for (index, body) in bodies.iter_mut().enumerate() {
        let is_free = body.kind == BodyKind::Dynamic && !is_held(index);
        body.inverse_mass = if is_free { engine.inverse_mass(index) } else { 0.0 };
        body.inverse_inertia = if is_free { engine.inverse_inertia(index) } else { Mat3::ZERO };
    }
}

/// Momenta of bodies that forces move.
fn momenta(engine: &dyn RigidEngine, bodies: &[Body]) -> Vec<Momentum> {
    let bodies = bodies.iter().enumerate();
    bodies.map(|(index, body)| Momentum::of(engine, index, body.inverse_mass)).collect()
}

/// What pushes the bodies in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pushes<'a> {
    /// Wrenches of fluid and sponges.
    pub(crate) given: &'a [(Wrench, Wrench)],
    /// Forces and torques of commands; empty without any.
    pub(crate) forces: &'a [[Vec3; 2]],
    /// What a turn of the container gives; empty if it does not turn.
    pub(crate) carried: &'a [Wrench],
}

/// Passes wrenches to the engine: those of fluid and sponges, the forces of commands, and those by a turn of the container. Stores the new
/// states of the bodies.
pub(crate) fn move_bodies(
    engine: &mut dyn RigidEngine,
    light: &LightBodies,
    bodies: &mut BodyStore,
    pushes: Pushes<'_>,
    (step, loads): (f32, &mut Loads),
) -> Result<(), RigidError> {
    let Pushes { given, forces, carried } = pushes;
    let mut wrenches = light.wrenches(engine, given, step);
    let mut by_host = vec![Wrench::default(); wrenches.len()];
    add_forces(forces, &bodies.states.0, &mut by_host, step);
    add_forces(forces, &bodies.states.0, &mut wrenches, step);
    for (wrench, carried) in wrenches.iter_mut().zip(carried) {
        wrench.impulse += carried.impulse;
        wrench.angular_impulse += carried.angular_impulse;
    }
    let before = momenta(engine, &bodies.states.0);
    engine.step(step, &wrenches)?;
    let after = momenta(engine, &bodies.states.0);
    let loads_of = |index: usize| {
        let inverse_mass = bodies.states.0[index].inverse_mass;
        let mass = if inverse_mass > 0.0 { 1.0 / inverse_mass } else { 0.0 };
        let weight = light.gravity() * (mass * step);
        let contact = before[index].beside(after[index], weight, &wrenches[index]);
        let (by_fluid, by_nodes) = given[index];
        [by_fluid, by_nodes, by_host[index], contact]
    };
    loads.add((0..given.len().min(before.len())).map(loads_of), step);
    for (index, body) in bodies.states.0.iter_mut().enumerate() {
        let state = engine.state(index);
        // The engine may be that of a host.
        check_state(index, &state)?;
        body.state = state;
    }
    Ok(())
}
