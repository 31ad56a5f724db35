//! What a sponge does as it becomes wet, as physics.

use glam::Vec3;

use super::{
    lattice::Lattice,
    scene::{FULL, Options, Scene, best, blocks},
};
use crate::columns::lane;
use crate::params::{Solver, WettingParams};

/// Fluid and sponges that nothing else touches, as porous media.
fn free() -> Scene {
    let options =
        Options { bodies: false, walls: false, incompressible: true, porous: true, wetting: true, ..FULL };
    Scene::new(options)
}

fn set_wetting(scene: &mut Scene, wetting: &WettingParams) {
    scene.params.sponges.iter_mut().for_each(|sponge| sponge.wetting = wetting.clone());
}

#[test]
fn a_swollen_lattice_is_at_rest() {
    for swelling in [0.1, 0.0] {
        let mut scene = free();
        set_wetting(&mut scene, &WettingParams { softening: 0.5, swelling, ..WettingParams::default() });
        scene.params.gravity = Vec3::ZERO;
        scene.params.sponges.iter_mut().for_each(|sponge| sponge.solver = Solver::Vbd);
        let nodes = &mut scene.columns.nodes;
        for (node, [x, y, z]) in Lattice::new(&blocks(), 8).position.into_iter().enumerate() {
            let w = nodes.position[node][lane::nodes::position::INVERSE_MASS];
            nodes.position[node] = [1.1 * (x - 0.04), 1.1 * (y - 0.02), 1.1 * (z - 0.02), w];
        }
        nodes.velocity.fill([0.0; 4]);
        nodes.wetting.fill([1.0; 4]);
        let before = nodes.position.clone();
        let names = ["pbd::gravity", "pbd::predict", "pbd::guess", "pbd::vbd", "pbd::reaction"];
        scene.run(&best(), &names);
        let moved = before.iter().zip(&scene.columns.nodes.predicted).take(scene.columns.rows.nodes);
        let moved = moved
            .map(|(a, b)| (0..3).map(|k| f64::from(a[k] - b[k]).powi(2)).sum::<f64>().sqrt())
            .fold(0.0, f64::max);
        // Negative control: what does not swell draws itself together.
        assert_eq!(moved < 1e-7, swelling > 0.0, "{moved:.1e} m with a swelling of {swelling}");
    }
}

#[test]
fn drag_in_partly_filled_pores_follows_the_relative_permeability() {
    let mut scene = free();
    set_wetting(&mut scene, &WettingParams { exponent: 4, ..WettingParams::default() });
    let mut scene = scene.before("couple::wetting", &best());
    let mut rates = Vec::new();
    for filled in [1.0_f32, 0.5, 0.001] {
        // What the kernel makes that saturation of, whatever lies around a node.
        for (row, node) in scene.columns.controls.node.iter().enumerate() {
            let interior = scene.columns.nodes.interior[*node as usize].max(1.0);
            scene.columns.controls.saturation[row] = filled / interior;
        }
        scene.run(&best(), &["couple::wetting", "couple::pores", "couple::interior"]);
        rates.push(scene.columns.fluid.drag_rate.clone());
    }
    let mut inside = 0;
    let rows = rates[0].iter().zip(&rates[1]).zip(&rates[2]).take(scene.columns.rows.fluid);
    for ((full, half), dry) in rows {
        let [full, half, dry] = [full, half, dry].map(|rate| rate.map(f64::from));
        if full[0] > 0.0 {
            inside += 1;
            // S / k_r = 1 / S^3, and its root for fast water.
            assert!((half[0] / full[0] / 8.0 - 1.0).abs() < 1e-5, "{half:?} {full:?}");
            assert!((dry[0] / full[0] / 1000.0 - 1.0).abs() < 1e-5, "bounded: {dry:?} {full:?}");
        }
        if full[1] > 0.0 {
            assert!((half[1] / full[1] / 8.0_f64.sqrt() - 1.0).abs() < 1e-5, "{half:?} {full:?}");
        }
    }
    assert!(inside > 100, "{inside} particles inside");
}

/// Moves the water through the sponges as a whole, there and back several times. Gives the work of suction on it in the last cycle, and the
/// largest amount of work meanwhile \[J\].
fn work_of_a_cycle(receding: f32, way: f32) -> (f64, f64) {
    const STEPS: usize = 60;
    let mut scene = free();
    // The exponent does not change the suction: it makes sure that the kernel runs, whatever the pressure.
    set_wetting(&mut scene, &WettingParams { receding, exponent: 2, ..WettingParams::default() });
    scene.columns.nodes.wetting.fill([0.0; 4]);
    scene.columns.fluid.velocity.fill([0.0; 4]);
    let mass = f64::from(scene.params.fluid.particle_mass);
    let names =
        ["grid::sort_fluid", "couple::controls", "couple::saturation", "couple::wetting", "couple::suction"];
    let (mut work, mut largest, mut last) = (0.0, 0.0_f64, 0.0);
    for step in 0..=6 * STEPS {
        let within = step % (2 * STEPS);
        let shift = if within == 0 || within > STEPS { -way } else { way } / STEPS as f32;
        let shift = if step == 0 { 0.0 } else { shift };
        let rows = scene.columns.rows.fluid;
        scene.columns.fluid.position[..rows].iter_mut().for_each(|x| x[0] += shift);
        scene.columns.fluid.acceleration = vec![[0.0; 4]; scene.columns.fluid.position.len()];
        scene.run(&best(), &names);
        let pull = scene.columns.fluid.acceleration[..rows].iter();
        let force = mass * pull.map(|a| f64::from(a[0])).sum::<f64>();
        if step > 4 * STEPS {
            work += 0.5 * (last + force) * f64::from(shift);
            largest = largest.max(work.abs());
        }
        last = force;
    }
    (work, largest)
}

#[test]
fn a_cycle_of_wetting_loses_energy_and_never_gains_any() {
    let way = 0.02;
    let (conservative, scale) = work_of_a_cycle(0.0, way);
    assert!(conservative.abs() < 1e-3 * scale, "{conservative:.2e} J of {scale:.2e}");
    let (lost, scale) = work_of_a_cycle(300.0, way);
    assert!(lost < -0.05 * scale, "{lost:.2e} J of {scale:.2e}");
    // Swaying within the band gives back what it takes.
    let (swaying, scale) = work_of_a_cycle(300.0, 0.0002);
    assert!(swaying.abs() < 0.02 * scale, "{swaying:.2e} J of {scale:.2e}");
    // Negative control: a sponge that lets go of water more easily than it takes it is a pump.
    let (gained, scale) = work_of_a_cycle(-100.0, way);
    assert!(gained > 0.02 * scale, "{gained:.2e} J of {scale:.2e}");
}

#[test]
fn a_face_has_suction_as_far_as_another_covers_it() {
    let mut covers = Vec::new();
    // In edges of the thin block, which lies 0.45 above another. Its middle is a little more than an edge from the rims of both.
    for (shift, least, most) in [(-0.45, 0.7, 1.0), (-0.15, 0.33, 0.45), (0.25, 0.0, 0.01)] {
        let options =
            Options { bodies: false, walls: false, incompressible: true, porous: true, touch: true, ..FULL };
        let mut scene = Scene::new(options);
        let nodes = &mut scene.columns.nodes;
        for node in 0..scene.columns.rows.nodes {
            let [x, y, z, _] = nodes.rest[node];
            let up = if nodes.sponge[node] == 2 { shift * 0.01 } else { 0.0 };
            let w = nodes.position[node][lane::nodes::position::INVERSE_MASS];
            nodes.position[node] = [x, y + up, z, w];
        }
        let mut scene = scene.before("couple::contact_suction", &best());
        let before = scene.columns.controls.suction.clone();
        scene.run(&best(), &["couple::contact_suction"]);
        let columns = &scene.columns;
        let middle = |node: &usize| {
            let [x, y, z, _] = columns.nodes.rest[*node];
            columns.nodes.sponge[*node] == 2
                && y < 0.045
                && (0.02..0.035).contains(&x)
                && (0.015..0.03).contains(&z)
        };
        let faces: Vec<usize> = (0..columns.rows.nodes).filter(middle).collect();
        assert_eq!(faces.len(), 4);
        let own: Vec<f32> = faces.iter().map(|node| columns.nodes.cover[*node]).collect();
        assert!(own.iter().all(|cover| (least..=most).contains(cover)), "{own:?} at a shift of {shift}");
        for (row, node) in columns.controls.node.iter().enumerate() {
            let cover = columns.nodes.cover[*node as usize];
            let [was, is] = [before[row], columns.controls.suction[row]];
            assert!(
                if cover > 0.0 { is < was } else { is == was },
                "{was} {is} of a node covered by {cover}"
            );
        }
        covers.push(own[0]);
    }
    // Negative control: the gap counts.
    assert!(covers[0] > covers[1] && covers[1] > covers[2], "{covers:?}");
}

#[test]
fn a_squeezed_sponge_has_no_more_inside_than_one_at_rest() {
    for height in [1.0_f32, 0.6] {
        let mut scene = free();
        scene.columns.nodes.wetting.fill([0.0; 4]);
        for [_, y, _, _] in &mut scene.columns.nodes.position[..scene.columns.rows.nodes] {
            *y *= height;
        }
        for [_, y, _, _] in &mut scene.columns.fluid.position[..scene.columns.rows.fluid] {
            *y *= height;
        }
        let mut scene = scene.before("couple::interior", &best());
        scene.run(&best(), &["couple::interior"]);
        let fluid = &scene.columns.fluid;
        let rows = fluid.interior.iter().zip(&fluid.drag_rate).take(scene.columns.rows.fluid);
        let weight = |rate: &[f32; 4]| rate[lane::fluid::drag_rate::NODE_WEIGHT];
        let deep: Vec<(f32, f32)> = rows
            .map(|(interior, rate)| (*interior, weight(rate)))
            .filter(|(_, weight)| *weight > 0.9 / height)
            .collect();
        assert!(deep.len() > 20, "{} deep inside", deep.len());
        let mean = |of: fn(&(f32, f32)) -> f32| deep.iter().map(of).sum::<f32>() / deep.len() as f32;
        assert!((mean(|row| row.0) - 1.0).abs() < 0.05, "{} at {height}", mean(|row| row.0));
        // Negative control: the sum of the weights counts more nodes where the sponge is squeezed.
        assert_eq!(mean(|row| row.1) > 1.3, height < 1.0, "{} at {height}", mean(|row| row.1));
    }
}
