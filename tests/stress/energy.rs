//! What energy a scene has, and how much was put into it.

use sorb::{
    World, internal,
    rigid::{BodyKind, BodyState},
};

/// Energy that was there or came in from outside \[J\].
///
/// Bodies on a script may give energy and take it: the work of every step is added with its sign. Nodes that a grip holds give no
/// wrench, so that its work is not counted.
#[derive(Debug)]
pub(crate) struct Budget {
    /// Kinetic, potential and elastic energy at time zero, and all that suction and surface tension can still do.
    start: f64,
    /// Work of the bodies on a script.
    work: f64,
    /// Sum of the sizes of the works: what the error is measured against.
    exchanged: f64,
    states: Vec<BodyState>,
}

impl Budget {
    pub(crate) fn of(world: &World) -> Self {
        let start = energy(world) + capillary(world) + surface(world);
        Self { start, work: 0.0, exchanged: 0.0, states: states(world) }
    }

    /// Adds the work of the step that was just taken: impulses on a body act at its velocity before.
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

    /// Energy above what was put in, over what was put in; negative where some was lost.
    pub(crate) fn excess(&self, world: &World) -> f64 {
        (energy(world) - self.start - self.work) / (self.start.abs() + self.exchanged).max(1e-9)
    }
}

fn states(world: &World) -> Vec<BodyState> {
    world.bodies().iter().map(|body| body.state).collect()
}

fn energy(world: &World) -> f64 {
    let measures = world.measures();
    // Heights count from the floor, so that all of it is above zero.
    measures.kinetic_energy + measures.potential_energy + measures.elastic_energy
}

/// What suction can do at most: its pressure in a dry sponge times the volume of the pores.
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

/// What surface tension can do at most: every particle on its own has six faces.
fn surface(world: &World) -> f64 {
    let Some(fluid) = &world.scene().fluid else { return 0.0 };
    let face = f64::from(fluid.spacing).powi(2);
    6.0 * face * f64::from(fluid.surface_tension) * world.particle_ids().len() as f64
}

/// The largest of a sequence; not a number if one of them is not.
pub(crate) fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(
        f64::NEG_INFINITY,
        |most, value| {
            if value <= most || most.is_nan() { most } else { value }
        },
    )
}

#[test]
fn the_largest_is_not_fooled_by_what_is_not_a_number() {
    assert_eq!(largest([1.0, 3.0, 2.0]), 3.0);
    assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
}
