//! Repetitions that end when they have converged, on a number that is halved.

use std::sync::Arc;

use sorb_shaders::Shader;

use super::{
    device::Gpu,
    pipeline::Threads,
    program::{BoundStage, Dispatch, Program},
    resident::Resident,
    twins::{Pass, Rows},
    *,
};
use crate::tests::{
    gpu::LIMITS,
    scene::{FULL, Scene},
};

/// Density 0 is halved until it is small; density 1 counts the steps.
static HALVING: Shader = Shader {
    name: "test::halving",
    common: &[],
    own: "",
    source: concat!(
        include_str!("../../../shaders/common/rows.wgsl"),
        include_str!("../../../shaders/common/end_of_round.wgsl"),
        "
@group(0) @binding(0) var<storage, read_write> clock: Clock;
@group(0) @binding(1) var<storage, read_write> fluid_density: array<f32>;

@compute @workgroup_size(1)
fn before() {
    if (clock.running == 0u) { return; }
    fluid_density[0] = 1.0;
}

fn take_round(lane: u32) {
    fluid_density[lane] *= 0.5;
}

fn has_converged() -> bool {
    return fluid_density[0] <= 0.01;
}

@compute @workgroup_size(1)
fn halve(@builtin(local_invocation_index) lane: u32) {
    run_round(lane, true);
}

@compute @workgroup_size(1)
fn after() {
    if (clock.running == 0u) { return; }
    fluid_density[1] += 1.0;
}
"
    ),
};

/// Rounds until one half, one quarter, .. is below a hundredth.
const NEEDED: u32 = 7;

fn dispatch(resident: &Resident, entry: &'static str) -> Vec<Dispatch> {
    let pass = Pass { shader: "test::halving", entry, rows: Rows::One, names: &[] };
    let pipeline = Arc::new(resident.gpu.compile(&HALVING, entry, Threads { group: 1, shares: 1 }));
    let bind = resident.bind_group(&pass, &pipeline, 0, &[]);
    vec![Dispatch { kernel: "test::halving", pipeline, bind, groups: [1, 1, 1] }]
}

/// What steps of a repetition of at most `maximum` rounds, of which `planned` are encoded at first, leave behind.
fn halved(maximum: u32, planned: u32, steps: u32) -> (Vec<u32>, Answer) {
    let scene = Scene::new(FULL);
    let fail = |error: GpuError| -> ! { panic!("{error}") };
    let gpu = Arc::new(Gpu::new().unwrap_or_else(|error| fail(error)));
    let mut resident =
        Resident::new(&gpu, &scene.columns, &scene.params, LIMITS).unwrap_or_else(|error| fail(error));
    let mut program = resident.program(&[]).unwrap_or_else(|error| fail(error));
    let mut rounds =
        resident.rounds(maximum, 1, dispatch(&resident, "halve")).unwrap_or_else(|error| fail(error));
    rounds.planned = planned;
    program.step = vec![
        BoundStage::Once(dispatch(&resident, "before")),
        BoundStage::Rounds(rounds),
        BoundStage::Once(dispatch(&resident, "after")),
    ];
    resident.set_time(&Start {
        left: f32::MAX,
        fluid_speed: 1.0,
        fluid_acceleration: 1.0,
        node_speed: 1.0,
        fluid_pressure: 0.0,
    });
    let answer = resident.advance(&mut program, steps, None).unwrap_or_else(|error| fail(error));
    let found = resident.read(&[("fluid_density", 8)]).unwrap_or_else(|error| fail(error)).concat();
    assert!(planned_at_most(&mut program, maximum));
    (found, answer)
}

fn planned_at_most(program: &mut Program, maximum: u32) -> bool {
    program.step.iter().all(|part| match part {
        BoundStage::Rounds(rounds) => rounds.planned <= maximum,
        BoundStage::Once(_) => true,
    })
}

#[test]
fn rounds_end_when_they_have_converged_however_many_are_encoded() {
    for (planned, steps) in [(1, 1), (1, 5), (4, 1), (4, 20), (64, 1), (64, 5)] {
        let (found, answer) = halved(64, planned, steps);
        let expected = [0.5_f32.powi(NEEDED as i32), steps as f32].map(f32::to_bits);
        assert_eq!(found, expected, "{planned} {steps}");
        assert_eq!((answer.outcome, answer.steps), (Outcome::Done, steps), "{planned}");
        assert_eq!((answer.rounds, answer.maximum_rounds[0]), (steps * NEEDED, NEEDED), "{planned} {steps}");
    }
}

#[test]
fn rounds_end_at_the_maximum() {
    for planned in [1, 3, 5] {
        let (found, answer) = halved(5, planned, 3);
        assert_eq!(found, [0.5_f32.powi(5), 3.0].map(f32::to_bits), "{planned}");
        assert_eq!((answer.rounds, answer.maximum_rounds[0]), (15, 5), "{planned}");
    }
}
