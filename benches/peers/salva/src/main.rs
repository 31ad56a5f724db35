//! The dam break of `dam_16.toml` and `dam_37.toml` with salva, as JSON: `salva-dam N STEP TOLERANCE`.
//!
//! N particles across the base, steps of STEP seconds, a mean density error of TOLERANCE. The walls are one layer of particles half a
//! spacing behind the faces, for salva has no others.

use std::{env, process::ExitCode, time::Instant};

use salva3d::{
    LiquidWorld,
    math::Vector,
    object::{Boundary, Fluid, interaction_groups::InteractionGroups},
    solver::{ArtificialViscosity, DFSPHSolver},
};

/// Length of the base of the column \[m\].
const BASE: f32 = 0.5;
/// Extents of the tank \[m\].
const TANK: [f32; 3] = [1.5, 1.2, 0.5];
/// End of the run \[s\].
const END: f64 = 0.5;

fn main() -> ExitCode {
    let arguments: Vec<f64> = env::args().skip(1).filter_map(|text| text.parse().ok()).collect();
    let [across, step, tolerance] = arguments[..] else {
        eprintln!("salva-dam N STEP TOLERANCE");
        return ExitCode::from(2);
    };
    let spacing = BASE / across as f32;
    let mut solver: DFSPHSolver = DFSPHSolver::new();
    solver.max_density_error = 100.0 * tolerance as f32;
    let mut world = LiquidWorld::new(solver, 0.5 * spacing, 2.0, 1.0);
    let groups = InteractionGroups::default();
    let counts = [BASE, 2.0 * BASE, BASE].map(|extent| (extent / spacing).round() as i32);
    let column = lattice([0; 3], counts, spacing, |_| true);
    let particles = column.len();
    let mut fluid = Fluid::new(column, 0.5 * spacing, 1000.0, groups);
    fluid.nonpressure_forces.push(Box::new(ArtificialViscosity::new(0.01, 0.0)));
    let fluid = world.add_fluid(fluid);
    let counts = TANK.map(|extent| (extent / spacing).round() as i32);
    let walls = lattice([-1; 3], counts.map(|count| count + 1), spacing, |place| {
        (0..3).any(|axis| place[axis] < 0 || place[axis] >= counts[axis])
    });
    world.add_boundary(Boundary::new(walls, groups));

    let gravity = Vector::new(0.0, -9.81, 0.0);
    let (mut time, mut steps, mut wall) = (0.0, 0_u32, 0.0);
    let mut fronts = Vec::new();
    while time < END {
        let start = Instant::now();
        world.step(step as f32, &gravity);
        wall += start.elapsed().as_secs_f64();
        time += step;
        steps += 1;
        let mut along: Vec<f32> = world.fluids()[fluid].positions.iter().map(|point| point.x).collect();
        along.sort_by(f32::total_cmp);
        // The outermost row across the tank, so that single drops do not count.
        fronts.push(format!("[{time:.6},{:.6}]", along[particles - across as usize] + 0.5 * spacing));
    }
    println!(
        "{{\"particles\":{particles},\"steps\":{steps},\"wall_s\":{wall:.6},\"fronts\":[{}]}}",
        fronts.join(",")
    );
    ExitCode::SUCCESS
}

/// Centres of cells from `first` up to `end`, where a condition holds.
fn lattice(first: [i32; 3], end: [i32; 3], spacing: f32, has: impl Fn([i32; 3]) -> bool) -> Vec<Vector<f32>> {
    let mut points = Vec::new();
    for x in first[0]..end[0] {
        for y in first[1]..end[1] {
            for z in first[2]..end[2] {
                if has([x, y, z]) {
                    let [x, y, z] = [x, y, z].map(|index| (index as f32 + 0.5) * spacing);
                    points.push(Vector::new(x, y, z));
                }
            }
        }
    }
    points
}
