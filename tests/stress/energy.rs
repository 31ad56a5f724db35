//! Energy of a scene, and the energy put into it.

use sorb::{
    World, internal,
    rigid::{BodyKind, BodyState},
};

/// Initial and external energy \[J\].
///
/// Scripted bodies may add energy and remove it: the work of every step counts with its sign. Nodes in a grip give it no
/// wrench, so that its work is not counted.
#[derive(Debug)]
pub(crate) struct Budget {
    /// Kinetic, potential and elastic energy at time zero, and the largest possible work of suction and surface tension.
    start: f64,
    /// Work of the scripted bodies.
    work: f64,
    /// Sum of the absolute works: the scale of the error.
    exchanged: f64,
    states: Vec<BodyState>,
}

impl Budget {
    pub(crate) fn of(world: &World) -> Self {
        let start = energy(world) + capillary(world) + surface(world);
        Self { start, work: 0.0, exchanged: 0.0, states: states(world) }
    }

    /// Adds the work of the last step: impulses on a body act at its velocity before.
    pub(crate) fn add_step(&mut self, world: &World) {
        let (bodies, count) = (&internal::columns(world).bodies, world.bodies().len());
        for (body, state) in self.states.iter().enumerate() {
            if world.rigid_engine().kind(body) != BodyKind::Kinematic {
                continue;
            }
            for wrenches in [&bodies.fluid_wrenches, &bodies.node_wrenches] {
                let wrench = wrenches.total(body, count);
                let linear = wrench.impulse.dot(state.linear_velocity.as_dvec3());
                let angular = wrench.angular_impulse.dot(state.angular_velocity.as_dvec3());
                self.work -= linear + angular;
                self.exchanged += (linear + angular).abs();
            }
        }
        self.states = states(world);
    }

    /// Energy gained, over the energy put in; negative for a loss.
    pub(crate) fn excess(&self, world: &World) -> f64 {
        (energy(world) - self.start - self.work) / (self.start.abs() + self.exchanged).max(1e-9)
    }
}

fn states(world: &World) -> Vec<BodyState> {
    world.bodies().iter().map(|body| body.state).collect()
}

fn energy(world: &World) -> f64 {
    let measures = world.measures();
    // Heights are above the floor, so that all of it is positive.
    measures.kinetic_energy + measures.potential_energy + measures.elastic_energy
}

/// Largest possible work of suction: its pressure in a dry sponge times the volume of the pores.
fn capillary(world: &World) -> f64 {
    let scene = world.scene();
    if scene.fluid.is_none() {
        return 0.0;
    }
    let lattice = world.lattice();
    let nodes = lattice.node_volume.iter().zip(&lattice.node_sponge);
    let work = nodes.map(|(volume, sponge)| {
        let sponge = &scene.sponges[*sponge as usize];
        let pressure = sponge.entry_pressure * (1.0 + sponge.saturation_gain);
        f64::from(pressure * sponge.porosity * volume)
    });
    work.sum()
}

/// Largest possible work of surface tension: every single particle has six faces.
fn surface(world: &World) -> f64 {
    let Some(fluid) = &world.scene().fluid else { return 0.0 };
    let face = f64::from(fluid.spacing).powi(2);
    6.0 * face * f64::from(fluid.surface_tension) * world.particle_ids().len() as f64
}

/// The largest of a sequence; NaN if one of them is NaN.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, |maximum, value| {
        if value <= maximum || maximum.is_nan() { maximum } else { value }
    })
}

#[test]
fn the_largest_is_not_fooled_by_what_is_not_a_number() {
    assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
    assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
}
