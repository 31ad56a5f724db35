//! States that no host can write, put into the columns. These are values that are not finite, nodes and particles at one place,
//! inverted tets, and steps far beyond stability.

use super::*;
use crate::scene::preset;
use glam::Vec3;
use sorb_kernels::{
    body::BodyState,
    column::{Element, PlainMut},
};

/// A scene of the library in which everything interacts, after some steps.
fn busy(name: &str) -> World {
    let scene = preset(name).and_then(|scene| scene.scaled(0.4));
    let mut scene = scene.unwrap_or_else(|error| panic!("{name}: {error}"));
    let top = scene.sponges.first().map_or(0.08, |sponge| sponge.maximum().y);
    if let Some(body) = scene.bodies.first_mut() {
        (body.position.y, body.linear_velocity.y) = (top + 0.031, -1.0);
        // So light that a sponge under it has nearly its volume at rest.
        body.density = 1000.0;
    }
    let mut world = World::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    for _ in 0..6 {
        world.step().unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    world
}

/// Where a number of the state is.
#[derive(Clone, Copy)]
enum Place {
    /// A lane of the middle row of a column.
    Lane(Column, usize),
    /// A number of the first body.
    Body(fn(&mut BodyState) -> &mut f32),
}

/// Columns of the state whose lanes are overwritten.
const COLUMNS: [Column; 4] =
    [Column::FluidPosition, Column::FluidVelocity, Column::NodePosition, Column::NodeVelocity];

/// Numbers of a body.
const BODY: [(&str, Place); 4] = [
    ("bodies.states.position", Place::Body(|state| &mut state.position.y)),
    ("bodies.states.rotation", Place::Body(|state| &mut state.rotation.x)),
    ("bodies.states.linear_velocity", Place::Body(|state| &mut state.linear_velocity.y)),
    ("bodies.states.angular_velocity", Place::Body(|state| &mut state.angular_velocity.y)),
];

/// The name of a lane: of the axis in a vector, else the first one that the column declares.
fn lane_name(column: Column, index: usize) -> String {
    let Element::Rows(lanes) = column.element() else { panic!("{}: not rows", column.name()) };
    let declared = lanes.iter().find(|lane| lane.index == index && !lane.name.is_empty());
    let axes = ["x", "y", "z"];
    declared.map_or_else(|| axes[index].to_owned(), |lane| lane.name.to_ascii_lowercase())
}

/// All numbers of the state of the middle particle, the middle node and the first body.
fn places() -> Vec<(String, Place)> {
    let of_column = |column: Column| {
        let name = move |index| format!("{}.{}", column.name(), lane_name(column, index));
        (0..4).map(move |index| (name(index), Place::Lane(column, index)))
    };
    let lanes = COLUMNS.into_iter().flat_map(of_column);
    lanes.chain(BODY.into_iter().map(|(name, place)| (name.to_owned(), place))).collect()
}

/// The number at a place.
fn number(columns: &mut Columns, place: Place) -> &mut f32 {
    match place {
        Place::Lane(column, index) => {
            let row = columns.rows.of(column.store()) / 2;
            let Some(PlainMut::Rows(rows)) = columns.data_mut(column).plain_mut() else {
                panic!("{}: not rows", column.name())
            };
            &mut rows[row][index]
        }
        Place::Body(of) => of(&mut columns.bodies.states.0[0].state),
    }
}

/// Faults that no step notices, and that are gone afterwards.
///
/// The engine owns the bodies: their column is written anew in every step, and a body without a position or rotation has no contact. A
/// permitted compression that is invalid begins anew (`sph::predict`). The solve for the divergence has no use for the pressure of
/// particles.
const SILENT: &[&str] = &[
    "fluid.position.pressure_over_squared_density = NaN: kept",
    "fluid.position.pressure_over_squared_density = inf: kept",
    "fluid.position.pressure_over_squared_density = -inf: kept",
    "fluid.velocity.volume = NaN: gone",
    "fluid.velocity.volume = inf: gone",
    "fluid.velocity.volume = -inf: gone",
    "bodies.states.position = NaN: gone",
    "bodies.states.position = inf: gone",
    "bodies.states.position = -inf: gone",
    "bodies.states.rotation = NaN: gone",
    "bodies.states.rotation = inf: gone",
    "bodies.states.rotation = -inf: gone",
];

fn is_finite(world: &World) -> bool {
    let rows = || world.particle_positions().iter().chain(world.node_positions());
    let speeds = world.particle_velocities().iter().chain(world.node_velocities());
    rows().chain(speeds).all(|row| row.iter().all(|value| value.is_finite()))
}

#[test]
fn what_is_not_finite_is_an_error_in_the_step_and_the_last_one() {
    let healthy = busy("ball_drop");
    let mut silent = Vec::new();
    for (name, place) in places() {
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let mut world = healthy.clone();
            *number(&mut world.stores.host, place) = value;
            let Err(error) = world.step() else {
                // The fault was overwritten before it was read, or it is still there.
                let finite = is_finite(&world);
                silent.push(format!("{name} = {value}: {}", if finite { "gone" } else { "kept" }));
                continue;
            };
            let text = error.to_string();
            let is_named = match &error {
                StepError::Particle { id, .. } => (*id as usize) < world.columns().rows.fluid,
                StepError::Node { node, .. } => (*node as usize) < world.columns().rows.nodes,
                StepError::Rigid(text) => text.contains("ball"),
                _ => false,
            };
            assert!(is_named, "{name} = {value}: {text}");
            let digest = world.digest();
            assert_eq!(world.step(), Err(error.clone()), "{name} = {value}");
            assert_eq!(world.advance_frame().map(|_| ()), Err(error), "{name} = {value}");
            assert_eq!(world.digest(), digest, "{name} = {value}: a failed world must stay as it is");
        }
    }
    let silent: Vec<&str> = silent.iter().map(String::as_str).collect();
    assert_eq!(silent, SILENT);
    // The control: without a fault.
    assert!(healthy.clone().step().is_ok());
}

/// Runs for some time, and returns the first fault on the way or at the end.
fn survives(world: &mut World, seconds: f64) -> Result<(), String> {
    let end = world.clock().time + seconds;
    let particles = world.particle_ids().len();
    let start = world.clock().steps;
    while world.clock().time < end {
        world.step().map_err(|error| error.to_string())?;
        if world.clock().steps > start + 100_000 {
            return Err("more than 100 000 steps".to_owned());
        }
    }
    let mut ids = world.particle_ids().to_vec();
    ids.sort_unstable();
    let all = ids.len() == particles && ids.iter().zip(0..).all(|(id, index)| *id == index);
    match (is_finite(world), all, outside(world)) {
        (true, true, 0) => Ok(()),
        (finite, all, outside) => {
            Err(format!("finite: {finite}, all particles: {all}, outside of the box: {outside}"))
        }
    }
}

/// Number of particles and nodes outside of the box, by a millimetre for nodes.
fn outside(world: &World) -> usize {
    let crate::scene::Domain::Box { minimum, maximum, .. } = world.scene().domain else { return 0 };
    let count = |rows: &[[f32; 4]], slack: f32| {
        let out = |row: &&[f32; 4]| {
            let point = Vec3::new(row[0], row[1], row[2]);
            point.cmplt(minimum - slack).any() || point.cmpgt(maximum + slack).any()
        };
        rows.iter().filter(out).count()
    };
    count(world.particle_positions(), 0.0) + count(world.node_positions(), 1e-3)
}

fn volume(world: &World) -> f64 {
    world.measures().sponge_volume / world.lattice().rest_volume(0).unwrap_or(f64::NAN)
}

/// Moves the nodes of a sponge about the centre of its box.
fn moved(world: &mut World, to: impl Fn(Vec3) -> Vec3) {
    let count = world.stores.host.rows.nodes;
    let nodes = &mut world.stores.host.nodes.position[..count];
    let centre = nodes.iter().map(|row| Vec3::new(row[0], row[1], row[2])).sum::<Vec3>() / count as f32;
    for row in nodes {
        let point = centre + to(Vec3::new(row[0], row[1], row[2]) - centre);
        (row[0], row[1], row[2]) = (point.x, point.y, point.z);
    }
}

/// Position of a node under a deformation, from the centre of the sponge \[m\].
type Deformation = fn(Vec3) -> Vec3;

/// Deformations beyond any material.
const DEFORMATIONS: &[(&str, Deformation)] = &[
    ("all nodes at one place", |_| Vec3::ZERO),
    ("all nodes in a plane", |x| Vec3::new(x.x, 0.0, x.z)),
    ("all nodes on a line", |x| Vec3::new(x.x, 0.0, 0.0)),
    ("mirrored: every tet is inside out", |x| Vec3::new(-x.x, x.y, x.z)),
    ("turned inside out about its centre", |x| -x),
    ("half of its size", |x| 0.5 * x),
    ("a third of its size", |x| 0.33 * x),
    ("a tenth of its size", |x| 0.1 * x),
    ("every node somewhere", |x| {
        // A pattern that does not follow the lattice.
        let scramble = |value: f32| libm::sinf(12_345.6 * value) * 0.03;
        Vec3::new(scramble(x.y + 0.3 * x.z), scramble(x.z + 0.3 * x.x), scramble(x.x + 0.3 * x.y))
    }),
];

/// Deformations from which sponges do not recover; known faults.
///
/// Nodes at one place have no preferred direction; a ball and water provide one. A sponge with every tet inverted would have
/// to pass through itself, and ends tangled. Ten scrambled sponges under a ball in water come back to 0.90 to 0.97 of their volume with
/// smoothed coupling weights. With barycentric ones it is 0.87 to 0.96. Some tets stay inverted.
const NOT_RECOVERED: &[(&str, &str)] = &[
    ("dry", "all nodes at one place"),
    ("dry", "mirrored: every tet is inside out"),
    ("dry", "turned inside out about its centre"),
    ("ball_drop", "mirrored: every tet is inside out"),
    ("ball_drop", "turned inside out about its centre"),
    ("ball_drop", "every node somewhere"),
];

#[test]
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn sponges_recover_unless_they_are_tangled() {
    let mut lost = Vec::new();
    for name in ["dry", "ball_drop"] {
        for (deformation, to) in DEFORMATIONS {
            let mut world = busy(name);
            moved(&mut world, to);
            let deformed = volume(&world);
            let start = world.clock().time;
            let mut result = Ok(());
            let mut recovered = None;
            while result.is_ok() && world.clock().time < start + 1.5 {
                result = survives(&mut world, 1.0 / 60.0);
                let back = (0.9..1.1).contains(&volume(&world));
                recovered = if back { recovered.or(Some(world.clock().time - start)) } else { None };
            }
            println!(
                "| {name}: {deformation} | {deformed:.3} | {:.3} | {recovered:?} | {result:?} |",
                volume(&world)
            );
            assert_eq!(result, Ok(()), "{name}: {deformation}");
            if recovered.is_none() {
                lost.push((name, *deformation));
            }
        }
    }
    assert_eq!(lost, NOT_RECOVERED);
}

/// Pairs of particles closer than a thousandth of the spacing.
fn together(world: &World) -> usize {
    let (rows, limit) = (world.particle_positions(), 1e-3 * world.params.fluid.spacing);
    let near = |a: &[f32; 4], b: &[f32; 4]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < limit);
    rows.iter().enumerate().map(|(row, a)| rows[..row].iter().filter(|b| near(a, b)).count()).sum()
}

#[test]
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn particles_at_one_place_are_driven_apart() {
    for (name, share) in
        [("two at every place", 2), ("ten at every place", 10), ("all at one place", 100_000)]
    {
        let mut world = busy("water");
        let count = world.stores.host.rows.fluid;
        let positions = &mut world.stores.host.fluid.position;
        for row in 0..count {
            let [x, y, z, _] = positions[row / share * share];
            (positions[row][0], positions[row][1], positions[row][2]) = (x, y, z);
        }
        assert!(together(&world) > 0, "{name}");
        let survived = survives(&mut world, 0.5);
        if share > 10 {
            // A known fault: more than the solve for the divergence parts. The step is refused, which says why.
            let refused = survived.expect_err(name);
            assert!(refused.contains("below time.minimum_step"), "{name}: {refused}");
            continue;
        }
        assert_eq!(survived, Ok(()), "{name}");
        let m = world.measures();
        println!(
            "| {name} | {} steps | {:.2} m/s | mean density error {:.3} | {} pairs at one place |",
            world.clock().steps,
            m.maximum_speed,
            m.mean_density_error,
            together(&world)
        );
        assert!(m.maximum_speed < 5.0, "{name}: {} m/s", m.maximum_speed);
        assert_eq!(together(&world), 0, "{name}");
    }
}

/// Times the stable step that a world takes without an error.
const LONG: f32 = 8.0;

#[test]
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn steps_far_beyond_what_is_stable() {
    for name in ["ball_drop", "dry", "water"] {
        for factor in [LONG, 100.0] {
            let mut world = busy(name);
            let (mut fastest, mut maximum, mut refused) = (0.0_f32, 0, false);
            for _ in 0..50 {
                let long = factor * world.steps.stable(&world.params, &world.clock).0;
                world.params.step = long;
                world.clock.steps += 1;
                world.clock.time += f64::from(long);
                let result = world.run_phases(long, &[]).and_then(|()| world.check());
                // Viscosity between particles is explicit: a hundred times its bound is an error that names a row.
                if factor > LONG && result.is_err() {
                    refused = true;
                    break;
                }
                assert_eq!(result, Ok(()), "{name} x{factor}");
                fastest = fastest.max(world.clock.fluid_speed).max(world.clock.node_speed);
                maximum = maximum.max(outside(&world));
            }
            if refused {
                println!("| {name} | {factor} | {fastest:.1} m/s | {maximum} outside | refused |");
                continue;
            }
            assert!(is_finite(&world), "{name} x{factor}");
            // Afterwards the world continues, or reports the step that it would need.
            let after = survives(&mut world, 0.1);
            println!("| {name} | {factor} | {fastest:.1} m/s | {maximum} outside | {after:?} |");
            let is_refused = after.as_ref().is_err_and(|text| text.contains("asks for a step of"));
            assert!(after.is_ok() || (factor > LONG && is_refused), "{name} x{factor}: {after:?}");
        }
    }
}
