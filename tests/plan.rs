//! The plan of a scene: its text is a golden, and phases without work are not in it.

mod common;

use sorb::{
    Cpu, World,
    internal::{
        self, POROUS_STEP, Phase, Plan, PlanError, Runner, STEP, Verdict,
        columns::{Column, Columns, RowCounts},
        contents::Contents,
        kernel::Kernel,
        need::Need,
        params::{Params, Solver, SpongeParams, WettingParams},
    },
    scene::Scene,
};

/// No column is observed beyond what phases read.
const NOTHING_OBSERVED: &[Column] = &[];

fn plan(name: &str) -> Plan {
    let scene = common::preset(name, 1.0);
    World::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}")).plan().clone()
}

fn running(plan: &Plan) -> Vec<&'static str> {
    plan.lines().iter().filter(|line| line.verdict == Verdict::Runs).map(|line| line.name).collect()
}

fn verdict(plan: &Plan, name: &str) -> Verdict {
    plan.lines()
        .iter()
        .find(|line| line.name == name)
        .map_or_else(|| panic!("no {name}"), |line| line.verdict)
}

macro_rules! plans {
    ($($scene:ident)+) => {
        $(#[test]
        fn $scene() {
            let name = stringify!($scene);
            common::golden(&format!("plan_{name}"), &plan(name).to_string());
        })+
    };
}
sorb::for_every_preset!(plans);

#[test]
fn a_scene_without_sponge_runs_no_phase_of_it() {
    let plan = plan("water");
    let names = running(&plan);
    assert!(names.contains(&"sph::forces") && names.contains(&"sph::advect"), "{names:?}");
    for family in ["pbd::", "couple::", "rigid::"] {
        assert!(!names.iter().any(|name| name.starts_with(family)), "{family} in {names:?}");
    }
}

#[test]
fn a_scene_without_water_runs_no_phase_of_it() {
    let plan = plan("dry");
    let names = running(&plan);
    assert!(names.contains(&"pbd::vbd") && names.contains(&"rigid::step"), "{names:?}");
    for family in ["grid::", "sph::", "couple::"] {
        assert!(!names.iter().any(|name| name.starts_with(family)), "{family} in {names:?}");
    }
}

#[test]
fn nothing_runs_where_nothing_is() {
    let plan = plan("empty");
    assert_eq!(running(&plan), Vec::<&str>::new());
    assert!(Runner::new(&plan).is_empty());
    assert!(!Runner::new(&self::plan("dry")).is_empty(), "the control has phases");
}

#[test]
fn every_phase_of_the_step_has_a_line_with_a_reason_if_it_is_skipped() {
    let lines = |name: &str| plan(name).lines().len();
    let (porous, divergence, other) = (lines("ball_drop"), lines("water"), lines("empty"));
    for name in common::busy::names() {
        let plan = plan(name);
        let expected = match name {
            "bobbing" | "water" => divergence,
            "dry" | "empty" => other,
            _ => porous,
        };
        assert_eq!(plan.lines().len(), expected, "{name}");
        for line in plan.lines() {
            if let Verdict::Skipped(reason) = line.verdict {
                assert!(!reason.is_empty(), "{name}: {}", line.name);
            }
        }
    }
    assert_eq!(verdict(&plan("water"), "pbd::strain"), Verdict::Skipped("no sponge"));
    assert_eq!(verdict(&plan("water"), "rigid::step"), Verdict::Skipped("no bodies"));
    assert_eq!(verdict(&plan("dry"), "sph::density"), Verdict::Skipped("no fluid"));
}

#[test]
fn contact_of_sponges_is_looked_for_only_where_there_can_be_any() {
    const NAMES: [&str; 2] = ["pbd::pairs", "pbd::touch"];
    let missing = Verdict::Skipped("no sponge can touch another or itself");
    let of = |scene: &Scene| common::world(scene).plan().clone();
    for (scene, expected) in [("ball_drop", missing), ("dry", missing), ("stack", Verdict::Runs)] {
        let plan = of(&common::preset(scene, 0.5));
        NAMES.iter().for_each(|name| assert_eq!(verdict(&plan, name), expected, "{scene}"));
    }
    let folds = common::with(&common::preset("dry", 0.5), &["sponges[0].self_contact=true"]);
    NAMES.iter().for_each(|name| assert_eq!(verdict(&of(&folds), name), Verdict::Runs));
    // Other solvers have none.
    let paper = common::with(&common::preset("stack", 0.5), &["sponges[1].solver=sbd"]);
    NAMES.iter().for_each(|name| assert_eq!(verdict(&of(&paper), name), missing));
    // Suction of faces that touch is of water.
    let suction = |scene: &Scene| verdict(&of(scene), "couple::contact_suction");
    assert_eq!(suction(&common::preset("stack", 0.5)), Verdict::Runs);
    assert_eq!(suction(&common::preset("ball_drop", 0.5)), missing);
}

#[test]
fn surface_tension_runs_only_where_it_is_above_zero() {
    let still = common::preset("water", 0.5);
    let pulled = common::with(&still, &["fluid.surface_tension=0.07"]);
    let of = |scene, name| verdict(common::world(scene).plan(), name);
    assert_eq!(of(&still, "sph::cohesion"), Verdict::Skipped("no surface tension by cohesion"));
    assert_eq!(of(&pulled, "sph::cohesion"), Verdict::Runs);
    // The model of the paper belongs to its solver.
    assert_eq!(
        of(&pulled, "sph::surface_tension"),
        Verdict::Skipped("no surface tension from the colour field")
    );
    let paper = common::with(&pulled, &["fluid.solver=wcsph"]);
    assert_eq!(of(&paper, "sph::surface_tension"), Verdict::Runs);
    assert_eq!(of(&paper, "sph::deficit"), Verdict::Skipped("no surface tension by cohesion"));
}

// Small steps of kernels that do nothing but declare.

fn idle(_: &Cpu, _: &Params, _: &mut Columns) {}

static DENSITY: Kernel =
    Kernel::bare("test::density", &[Need::Fluid], &[Column::FluidPosition], &[Column::FluidDensity], idle);
static ACCELERATION: Kernel = Kernel::bare(
    "test::acceleration",
    &[Need::Fluid],
    &[Column::FluidDensity],
    &[Column::FluidAcceleration],
    idle,
);
static VELOCITY: Kernel = Kernel::bare(
    "test::velocity",
    &[Need::Fluid],
    &[Column::FluidAcceleration, Column::FluidVelocity],
    &[Column::FluidVelocity],
    idle,
);
static SATURATION: Kernel = Kernel::bare(
    "test::saturation",
    &[Need::Fluid],
    &[Column::FluidPosition],
    &[Column::NodeSaturation],
    idle,
);

/// Plans a small step for a scene.
fn small_of(name: &str, step: &[Phase], observed: &[Column]) -> Result<Plan, PlanError> {
    let world = common::world(&common::preset(name, 0.5));
    internal::plan(step, &Contents::new(internal::params(&world), internal::columns(&world)), observed)
}

fn small(step: &[Phase], observed: &[Column]) -> Plan {
    small_of("water", step, observed).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_scratch_column_read_before_it_is_written_is_refused() {
    let honest = [Phase::Run(&DENSITY), Phase::Run(&ACCELERATION), Phase::Run(&VELOCITY)];
    assert_eq!(running(&small(&honest, NOTHING_OBSERVED)).len(), 3);
    let swapped = [Phase::Run(&ACCELERATION), Phase::Run(&DENSITY), Phase::Run(&VELOCITY)];
    let error = small_of("water", &swapped, NOTHING_OBSERVED).expect_err("density comes too late");
    assert_eq!((error.kernel, error.column), ("test::acceleration", "fluid.density"));
    assert!(error.to_string().contains("test::acceleration reads fluid.density"), "{error}");
    let missing = [Phase::Run(&ACCELERATION), Phase::Run(&VELOCITY)];
    assert!(small_of("water", &missing, NOTHING_OBSERVED).is_err(), "nobody writes the density");
    // A scratch column that the scene lacks cannot be read too early.
    assert!(small_of("empty", &swapped, NOTHING_OBSERVED).is_ok());
}

#[test]
fn what_nobody_reads_is_skipped_unless_it_is_observed() {
    let step =
        [Phase::Run(&DENSITY), Phase::Run(&SATURATION), Phase::Run(&ACCELERATION), Phase::Run(&VELOCITY)];
    let plan = small(&step, NOTHING_OBSERVED);
    assert_eq!(running(&plan), ["test::density", "test::acceleration", "test::velocity"]);
    assert_eq!(verdict(&plan, "test::saturation"), Verdict::Skipped("nobody reads what it writes"));
    assert_eq!(running(&small(&step, &[Column::NodeSaturation])).len(), 4);
    // Without the last reader, the whole chain before it is dead.
    let chain = [Phase::Run(&DENSITY), Phase::Run(&ACCELERATION)];
    assert_eq!(running(&small(&chain, NOTHING_OBSERVED)), Vec::<&str>::new());
    assert_eq!(running(&small(&chain, &[Column::FluidDensity])), ["test::density"]);
    assert_eq!(running(&small(&chain, &[Column::FluidAcceleration])).len(), 2);
}

/// Everything that phases may need, in a scene that has all of it.
const EVERYTHING: [&str; 4] = [
    "fluid.surface_tension=0.07",
    "fluid.viscosity_integration=\"implicit\"",
    "fluid.no_slip=true",
    "sponges[0].swelling=0.1",
];

#[test]
fn the_step_itself_is_consistent_for_every_content() {
    const SOLVERS: [Solver; 3] = [Solver::Sbd, Solver::Vbd, Solver::XpbdNeoHookean];
    let world = common::world(&common::with(&common::preset("ball_drop", 0.5), &EVERYTHING));
    let (all, rows) = (internal::params(&world), internal::columns(&world).rows);
    for bits in 0..8192_u32 {
        let has = |bit: u32| bits >> bit & 1 == 1;
        let mut params = all.clone();
        let solvers = (0..3).filter(|k| has(5 + k)).map(|k| SOLVERS[k as usize]);
        params.sponges = solvers.map(|solver| SpongeParams { solver, ..all.sponges[0].clone() }).collect();
        params.walls = all.walls.filter(|_| has(2));
        params.fluid.surface_tension = if has(4) { 0.07 } else { 0.0 };
        params.fluid.cohesion = all.fluid.cohesion.clone().filter(|_| has(9));
        params.no_slip = has(9);
        params.fluid.incompressible = all.fluid.incompressible.clone().filter(|_| has(8));
        if let Some(solve) = &mut params.fluid.incompressible {
            solve.projections = has(11).then_some(4);
        }
        params.fluid.implicit_viscosity = all.fluid.implicit_viscosity.filter(|_| has(10));
        if !has(12) {
            params.sponges.iter_mut().for_each(|sponge| sponge.wetting = WettingParams::default());
        }
        let count = |bit: u32, rows: usize| if has(bit) { rows } else { 0 };
        let rows = RowCounts {
            fluid: count(0, rows.fluid),
            nodes: count(1, rows.nodes),
            bodies: count(3, 1),
            ..rows
        };
        let plain = Params { solid: None, ..params.clone() };
        let contents = Contents { params: &plain, rows, bodies: &[], touch: has(2) };
        if let Err(error) = internal::plan(STEP, &contents, NOTHING_OBSERVED) {
            panic!("{contents:?}: {error}");
        }
        // Sponges as porous media need their solver, and a solve for the pressure.
        params.sponges = vec![SpongeParams { solver: Solver::Vbd, ..all.sponges[0].clone() }];
        params.fluid.incompressible = params.fluid.incompressible.or(all.fluid.incompressible.clone());
        let rows = RowCounts { nodes: internal::columns(&world).rows.nodes, ..rows };
        let contents = Contents { params: &params, rows, ..contents };
        if let Err(error) = internal::plan(POROUS_STEP, &contents, NOTHING_OBSERVED) {
            panic!("{contents:?}: {error}");
        }
    }
}

#[test]
fn a_plan_counts_repetitions_from_the_scene() {
    let scene = common::with(&common::preset("dry", 0.5), &["sponges[0].iterations=7"]);
    let world = common::world(&scene);
    let sweep = world.plan().lines().iter().find(|line| line.name == "pbd::vbd");
    assert_eq!(sweep.and_then(|line| line.repeat).map(|(_, times)| times), Some(7));
    let mut world = world;
    common::steps(&mut world, 3);
    let calls = |name: &str| world.phase_times().iter().find(|time| time.name == name).map(|time| time.calls);
    assert_eq!((calls("pbd::vbd"), calls("pbd::predict")), (Some(21), Some(3)));
    assert_eq!(calls("sph::density"), None, "a skipped phase is not timed");
}

#[test]
fn position_based_fluids_take_the_rounds_that_the_scene_says() {
    const NAMES: [&str; 4] =
        ["sph::factors", "sph::position_correction", "sph::pressure_residual", "sph::pressure_kick"];
    let calls = |keys: &[&str]| {
        let mut world = common::world(&common::with(&common::preset("water", 0.5), keys));
        common::steps(&mut world, 5);
        NAMES.map(|name| {
            world.phase_times().iter().find(|time| time.name == name).map_or(0, |time| time.calls)
        })
    };
    assert_eq!(calls(&["fluid.solver=pbf", "fluid.projections=3"]), [15, 15, 0, 0]);
    let [factors, moved, residual, kick] = calls(&["fluid.solver=dfsph", "fluid.projections=3"]);
    assert!((factors, moved, kick) == (5, 0, 5) && residual >= 5, "dfsph solves: {residual} rounds");
}

#[test]
fn implicit_viscosity_is_a_solve_that_ends_when_it_has_converged() {
    const NAMES: [&str; 4] =
        ["sph::viscosity_begin", "sph::viscosity_product", "sph::viscosity_update", "sph::wall_friction"];
    let calls = |keys: &[&str]| {
        let viscous = ["fluid.viscosity=10", "fluid.no_slip=true"];
        let mut world =
            common::world(&common::with(&common::preset("water", 0.5), &[&viscous, keys].concat()));
        common::steps(&mut world, 5);
        NAMES.map(|name| {
            world.phase_times().iter().find(|time| time.name == name).map_or(0, |time| time.calls)
        })
    };
    assert_eq!(calls(&[]), [0, 0, 0, 5], "friction is a force where viscosity is");
    let implicit = "fluid.viscosity_integration=\"implicit\"";
    let [loose, tight] = ["0.1", "1e-6"].map(|tolerance| {
        let [begin, product, update, friction] =
            calls(&[implicit, &format!("fluid.viscosity_tolerance={tolerance}")]);
        assert_eq!((begin, product, friction), (5, update, 0));
        product
    });
    assert!(loose >= 5 && tight > 2 * loose, "{loose} {tight}");
    assert_eq!(calls(&[implicit, "fluid.viscosity_tolerance=1e-6", "fluid.viscosity_rounds=3"])[1], 15);
    assert_eq!(
        calls(&[implicit, "fluid.viscosity=0", "fluid.artificial_viscosity=0"])[0],
        0,
        "nothing to solve"
    );
}

#[test]
fn a_pressure_solve_ends_when_it_has_converged() {
    const DFSPH: [&str; 3] = ["sph::pressure_update", "sph::pressure_residual", "sph::pressure_kick"];
    const DIVERGENCE: [&str; 3] = ["divergence::update", "divergence::residual", "divergence::kick"];
    for (solver, names) in [("dfsph", DFSPH), ("divergence", DIVERGENCE)] {
        let calls = |solver: &str, keys: &[&str]| {
            let chosen = format!("fluid.solver={solver}");
            let scene = common::with(&common::preset("water", 0.5), &[&[&*chosen], keys].concat());
            let mut world = common::world(&scene);
            common::steps(&mut world, 5);
            let times = world.phase_times();
            names.map(|name| times.iter().find(|time| time.name == name).map(|time| time.calls))
        };
        let loose = calls(solver, &["fluid.density_tolerance=0.1"]);
        let tight = calls(solver, &["fluid.density_tolerance=1e-6"]);
        for [update, residual, kick] in [loose, tight] {
            assert_eq!((update, kick), (residual, Some(5)), "{solver}");
        }
        assert!(loose[0] >= Some(5) && tight[0] > loose[0], "{solver}: {loose:?} {tight:?}");
        let bounded = calls(solver, &["fluid.density_tolerance=1e-6", "fluid.rounds=3"]);
        assert_eq!(bounded[0], Some(15), "{solver}: no more than asked for");
        assert_eq!(calls("wcsph", &[])[0], None);
    }
}
