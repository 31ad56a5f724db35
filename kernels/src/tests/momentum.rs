//! What one side gains, the other loses.

use glam::DVec3;

use super::scene::{FULL, Options, Scene, best};
use crate::body::Wrench;
use crate::columns::lane;

fn vector(row: [f32; 4]) -> DVec3 {
    DVec3::new(f64::from(row[0]), f64::from(row[1]), f64::from(row[2]))
}

/// Impulses at points: their sum, their moment about the origin, and the sums of the magnitudes of both.
#[derive(Clone, Copy, Debug, Default)]
struct Balance {
    impulse: DVec3,
    moment: DVec3,
    magnitude: f64,
    moment_magnitude: f64,
}

impl Balance {
    fn add(&mut self, impulse: DVec3, point: DVec3) {
        self.impulse += impulse;
        self.moment += point.cross(impulse);
        self.magnitude += impulse.length();
        self.moment_magnitude += point.cross(impulse).length();
    }

    /// Adds what bodies received.
    fn add_wrenches(&mut self, scene: &Scene, wrenches: &[Wrench]) {
        let bodies = &scene.columns.bodies.states.0;
        for (index, wrench) in wrenches.iter().enumerate() {
            let centre = bodies[index % bodies.len()].state.position.as_dvec3();
            self.impulse += wrench.impulse;
            self.moment += wrench.angular_impulse + centre.cross(wrench.impulse);
        }
    }

    fn error(&self) -> f64 {
        assert!(self.magnitude > 0.0, "nothing to balance");
        self.impulse.length() / self.magnitude
    }

    fn moment_error(&self) -> f64 {
        assert!(self.moment_magnitude > 0.0, "nothing to balance");
        self.moment.length() / self.moment_magnitude
    }
}

fn fluid_balance(scene: &Scene, offset: DVec3) -> Balance {
    let fluid = &scene.columns.fluid;
    let mut balance = Balance::default();
    for row in 0..scene.columns.rows.fluid {
        let force = f64::from(scene.params.fluid.particle_mass) * (vector(fluid.acceleration[row]) - offset);
        balance.add(force, vector(fluid.position[row]));
    }
    balance
}

fn pair_forces(viscosity: f32, central_viscosity: f32) -> Scene {
    let mut scene = Scene::new(FULL).before("sph::forces", &best());
    scene.params.fluid.viscosity = viscosity;
    scene.params.fluid.central_viscosity = central_viscosity;
    scene.run(&best(), &["sph::forces"]);
    scene
}

#[test]
fn pressure_and_viscosity_keep_momentum() {
    let mut scene = pair_forces(0.5, 0.5);
    let gravity = scene.params.gravity.as_dvec3();
    let balance = fluid_balance(&scene, gravity);
    assert!(balance.error() < 1e-6, "{:.1e}", balance.error());
    // Negative control: one particle in a thousand that feels double shows.
    let row = &mut scene.columns.fluid.acceleration[500];
    (0..3).for_each(|axis| row[axis] *= 2.0);
    assert!(fluid_balance(&scene, gravity).error() > 1e-5);
}

#[test]
fn pressure_and_central_viscosity_keep_angular_momentum() {
    let of = |viscosity, central| {
        let scene = pair_forces(viscosity, central);
        fluid_balance(&scene, scene.params.gravity.as_dvec3()).moment_error()
    };
    assert!(of(0.0, 0.0) < 1e-6, "{:.1e}", of(0.0, 0.0));
    assert!(of(0.0, 0.5) < 1e-6, "{:.1e}", of(0.0, 0.5));
    // The other viscosity does not, by its form: it acts along the difference of velocities, not along the pair.
    assert!(of(0.5, 0.0) > 1e-5, "the control");
}

/// Viscosity by the rate of strain: what of the spin it takes, as a share.
fn strained(share: f32, velocity: Option<fn(DVec3) -> DVec3>) -> Scene {
    let options = Options { strain_rate: true, ..FULL };
    let mut scene = Scene::new(options).before("sph::spin", &best());
    for row in 0..scene.columns.rows.fluid {
        let fluid = &mut scene.columns.fluid;
        fluid.acceleration[row] = [0.0; 4];
        if let Some(velocity) = velocity {
            let [x, y, z] = velocity(vector(fluid.position[row])).as_vec3().to_array();
            fluid.velocity[row] = [x, y, z, fluid.velocity[row][3]];
        }
    }
    scene.run(&best(), &["sph::spin"]);
    scene.columns.fluid.spin.iter_mut().flatten().for_each(|spin| *spin *= share);
    scene.run(&best(), &["sph::strain_rate"]);
    scene
}

#[test]
fn viscosity_by_the_rate_of_strain_keeps_both_momenta() {
    let of = |share| fluid_balance(&strained(share, None), DVec3::ZERO);
    let balance = of(1.0);
    assert!(balance.error() < 1e-6, "{:.1e}", balance.error());
    assert!(balance.moment_error() < 1e-6, "{:.1e}", balance.moment_error());
    // Negative control: with half of the spin torques are left.
    assert!(of(0.5).moment_error() > 1e-5, "{:.1e}", of(0.5).moment_error());
}

#[test]
fn fluid_that_turns_feels_no_viscosity_by_the_rate_of_strain() {
    let turn: fn(DVec3) -> DVec3 = |x| DVec3::new(1.0, 2.0, -3.0).cross(x);
    let of = |share| fluid_balance(&strained(share, Some(turn)), DVec3::ZERO).magnitude;
    // The matrix of the fit is regularised by 1e-4 of a trace, of which an axis has a third.
    assert!(of(1.0) < 5e-4 * of(0.0), "{:.1e} of {:.1e}", of(1.0), of(0.0));
}

/// Forces of suction on the particles and of the zero-distance constraints on the nodes.
fn suction_balance(reaction: f32) -> Balance {
    let free = Options { bodies: false, ..FULL };
    let mut scene = Scene::new(free).before("couple::zero_distance", &best());
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.reaction = reaction);
    scene.columns.fluid.acceleration.fill([0.0; 4]);
    scene.columns.nodes.acceleration.fill([0.0; 4]);
    scene.run(&best(), &["couple::suction", "couple::zero_distance"]);
    let mut balance = fluid_balance(&scene, DVec3::ZERO);
    let nodes = &scene.columns.nodes;
    for node in 0..scene.columns.rows.nodes {
        let mass = 1.0 / f64::from(nodes.position[node][lane::nodes::position::INVERSE_MASS]);
        balance.add(mass * vector(nodes.acceleration[node]), vector(nodes.position[node]));
    }
    balance
}

#[test]
fn suction_and_its_reaction_balance() {
    let balance = suction_balance(1.0);
    assert!(balance.error() < 1e-6, "{:.1e}", balance.error());
    assert!(balance.moment_error() < 1e-6, "{:.1e}", balance.moment_error());
    // Negative control: a reaction that is one per cent too weak shows.
    assert!(suction_balance(0.99).error() > 1e-5);
}

#[test]
fn repulsion_pushes_bodies_back() {
    let open = Options { walls: false, ..FULL };
    let mut scene = Scene::new(open).before("sph::repulsion", &best());
    scene.columns.fluid.acceleration.fill([0.0; 4]);
    scene.run(&best(), &["sph::repulsion"]);
    let mut forces = fluid_balance(&scene, DVec3::ZERO);
    let step = f64::from(scene.params.step);
    (forces.impulse, forces.moment) = (forces.impulse * step, forces.moment * step);
    (forces.magnitude, forces.moment_magnitude) = (forces.magnitude * step, forces.moment_magnitude * step);
    // Negative control: without the bodies the sum is far from zero.
    assert!(forces.error() > 1e-2 && forces.moment_error() > 1e-2);
    forces.add_wrenches(&scene, &scene.columns.bodies.fluid_wrenches.0);
    assert!(forces.error() < 1e-6, "{:.1e}", forces.error());
    assert!(forces.moment_error() < 1e-5, "{:.1e}", forces.moment_error());
}

#[test]
fn contact_pushes_bodies_back() {
    let open = Options { walls: false, ..FULL };
    for body in 0..5 {
        let mut scene = Scene::new(open).before("pbd::contact", &best());
        for (index, other) in scene.columns.bodies.states.0.iter_mut().enumerate() {
            other.touches_nodes = index == body;
        }
        let before = scene.columns.nodes.predicted.clone();
        scene.run(&best(), &["pbd::contact"]);
        let mut balance = Balance::default();
        for (node, old) in before.iter().enumerate().take(scene.columns.rows.nodes) {
            let new = scene.columns.nodes.predicted[node];
            let change = vector(new) - vector(*old);
            if change != DVec3::ZERO {
                let impulse =
                    change / f64::from(old[lane::nodes::position::INVERSE_MASS] * scene.params.step);
                balance.add(impulse, vector(new));
            }
        }
        // Negative control: without the bodies the sum is far from zero.
        assert!(balance.error() > 1e-2 && balance.moment_error() > 1e-2);
        balance.add_wrenches(&scene, &scene.columns.bodies.node_wrenches.0);
        // Displacements of a millimetre or less are differences of positions of decimetres.
        assert!(balance.error() < 1e-5, "body {body}: {:.1e}", balance.error());
        assert!(balance.moment_error() < 1e-5, "body {body}: {:.1e}", balance.moment_error());
    }
}
