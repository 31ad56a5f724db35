//! The presets, changed so that everything in them interacts from the first steps. For tests of single steps and benches,
//! where the scenes themselves take a while.

#![allow(dead_code, reason = "benches and tests use a part of it each")]

use sorb::{
    glam::Vec3,
    rigid::BodyKind,
    scene::{self, CouplingWeights, FluidSolver, Motion, Scene, Solver},
};

/// Names of all presets, in the order of the documentation.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    scene::presets().iter().map(|preset| preset.name)
}

/// The models of the paper, with moduli that are about as stiff.
pub(crate) fn as_in_the_paper(scene: &mut Scene) {
    if let Some(fluid) = &mut scene.fluid {
        fluid.solver = Some(FluidSolver::Wcsph);
    }
    let balls = scene.bodies.iter_mut().filter(|body| body.kind == BodyKind::Dynamic);
    balls.for_each(|ball| ball.density = 2500.0);
    for sponge in &mut scene.sponges {
        let modulus = if scene.fluid.is_some() { sponge.young_modulus } else { 1e4 };
        sponge.solver = Solver::Sbd;
        (sponge.stretch_modulus, sponge.volume_modulus) = (modulus, modulus);
        sponge.shear_modulus = 0.5 * modulus;
        // Without water one sweep per step gains energy under a heavy ball.
        sponge.iterations = if scene.fluid.is_some() { 1 } else { 8 };
    }
}

/// The solve for the divergence alone, around bodies that float and sink.
fn without_sponges(scene: &mut Scene) {
    scene.sponges.clear();
    if let Some(fluid) = &mut scene.fluid {
        fluid.solver = Some(FluidSolver::Divergence);
    }
    for body in &mut scene.bodies {
        (body.kind, body.density) = (BodyKind::Dynamic, 1200.0);
        body.motions.clear();
        body.position.y = 0.06;
    }
}

/// A preset at a resolution, in motion. `_paper` behind its name selects the models of the paper, `_pbf` position based fluids.
/// `_divergence` selects the solve for the divergence, in `life` without sponges. `_smoothed` selects the coupling by nodes within the
/// suction radius.
pub(crate) fn scene(name: &str, resolution: f32) -> Scene {
    let (name, paper) = name.strip_suffix("_paper").map_or((name, false), |name| (name, true));
    let (name, projected) = name.strip_suffix("_pbf").map_or((name, false), |name| (name, true));
    let (name, smoothed) = name.strip_suffix("_smoothed").map_or((name, false), |name| (name, true));
    let (name, divergence) = name.strip_suffix("_divergence").map_or((name, false), |name| (name, true));
    let mut scene = scene::preset(name)
        .and_then(|scene| scene.scaled(resolution))
        .unwrap_or_else(|error| panic!("{name}: {error}"));
    if paper {
        as_in_the_paper(&mut scene);
    }
    if let Some(fluid) = scene.fluid.as_mut().filter(|_| smoothed) {
        fluid.coupling_weights = Some(CouplingWeights::Smoothed);
    }
    if let Some(fluid) = scene.fluid.as_mut().filter(|_| projected) {
        fluid.solver = Some(FluidSolver::Pbf);
    }
    match name {
        "ball_drop" | "dry" => {
            // A radius of 3 cm just above the surface, off centre, falling.
            scene.bodies[0].position = Vec3::new(0.005, scene.sponges[0].maximum().y + 0.0305, 0.003);
            scene.bodies[0].linear_velocity = Vec3::new(0.1, -1.0, 0.0);
        }
        "squish" => {
            for (body, side) in scene.bodies.iter_mut().zip([-1.0, 1.0]) {
                body.position.x = side * 0.0452;
                let velocity = Vec3::new(-0.5 * side, 0.0, 0.0);
                body.motions = vec![Motion::Linear { velocity, start: 0.0, end: 0.05, ease: 0.0 }];
            }
        }
        "life" => {
            scene.sponges[0].position.y = 0.012;
            scene.bodies[0].position.y = scene.sponges[0].maximum().y + 0.031;
            let velocity = Vec3::new(0.0, -0.5, 0.0);
            scene.bodies[0].motions = vec![Motion::Linear { velocity, start: 0.0, end: 0.05, ease: 0.0 }];
        }
        "stack" => {
            // The upper sponge falls and slides, and the plate pushes it.
            scene.sponges[1].velocity = Vec3::new(0.1, -0.5, 0.05);
            scene.bodies[0].position.y = scene.sponges[1].maximum().y + 0.0051;
            let velocity = Vec3::new(0.0, -0.5, 0.0);
            scene.bodies[0].motions = vec![Motion::Linear { velocity, start: 0.0, end: 0.05, ease: 0.0 }];
        }
        "wring" => {
            for (body, rate) in scene.bodies.iter_mut().zip([20.0, -20.0]) {
                let (axis, pivot) = (Vec3::X, Vec3::new(0.0, 0.12, 0.0));
                body.motions = vec![Motion::Turn { axis, pivot, rate, start: 0.0, end: 0.1, ease: 0.0 }];
            }
        }
        "wipe" => {
            scene.sponges[0].saturation = 0.3;
            let velocity = Vec3::new(1.0, -0.1, 0.0);
            scene.bodies[0].motions = vec![Motion::Linear { velocity, start: 0.0, end: 0.05, ease: 0.02 }];
        }
        "dam_break" => {
            // Just right of the dam.
            scene.sponges[0].position.x = -0.236;
            scene.sponges[0].saturation = 0.3;
            start_flow(&mut scene);
        }
        "tap" | "cup" => {
            scene.sponges[0].saturation = 0.3;
            scene.emitters.iter_mut().for_each(|emitter| (emitter.start, emitter.end) = (0.0, 10.0));
            // The stream falls on the pipe.
            for body in scene.bodies.iter_mut().filter(|body| body.kind == BodyKind::Fixed) {
                body.position.y = scene.emitters[0].position.y - 0.038;
            }
            for body in scene.bodies.iter_mut().filter(|body| body.kind == BodyKind::Kinematic) {
                let velocity = Vec3::new(0.5, -0.3, 0.1);
                body.motions = vec![Motion::Linear { velocity, start: 0.0, end: 0.05, ease: 0.0 }];
            }
        }
        "bobbing" => {
            for body in &mut scene.bodies {
                body.position.y -= 0.045;
                body.linear_velocity = Vec3::new(0.2, -0.5, 0.1);
            }
        }
        "water" => start_flow(&mut scene),
        "standing" => {
            scene.sponges[0].velocity = Vec3::new(0.1, 0.0, 0.05);
            scene.sponges[0].saturation = 0.3;
        }
        _ => {}
    }
    match &mut scene.fluid {
        _ if divergence && name == "life" => without_sponges(&mut scene),
        Some(fluid) if divergence => fluid.solver = Some(FluidSolver::Divergence),
        _ => {}
    }
    scene
}

fn start_flow(scene: &mut Scene) {
    if let Some(fluid) = &mut scene.fluid {
        fluid.blocks[0].velocity = Vec3::new(1.0, 0.2, -0.1);
    }
}
