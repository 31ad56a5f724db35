//! Placement of kernels, and the lines of the plan about it.

use std::sync::Arc;

use sorb::{
    Offload, Options, World,
    glam::{UVec3, Vec3},
    gpu::{self, Gpu, wgpu},
    internal::{self, KERNELS, Place, Verdict},
    scene::{Domain, Scene, Solver, Sponge},
};

use super::{
    DFSPH, DIVERGENCE_AND_BODIES, HONEY, SMOOTHED, bound, busy, common, difference, gpu, shifted, world,
};

#[test]
fn every_kernel_can_be_the_first_on_the_gpu() {
    ["ball_drop", "ball_drop_paper"].into_iter().for_each(assert_each_can_be_the_first);
}

#[track_caller]
fn assert_each_can_be_the_first(name: &str) {
    let scene = busy::scene(name, 0.3);
    let mut cpu = world(&scene, Offload::Cpu);
    common::steps(&mut cpu, 2);
    let kernels = cpu.plan().lines().iter().filter(|line| line.verdict == Verdict::Runs);
    for kernel in kernels.map(|line| line.name).filter(|name| *name != "rigid::step") {
        let mut mixed = world(&scene, Offload::From(kernel));
        assert!(
            mixed.plan().lines().iter().any(|line| mixed.plan().place(line.name) == Place::Gpu),
            "{kernel}"
        );
        common::steps(&mut mixed, 2);
        let (found, what) = difference(&cpu.measures(), &mixed.measures());
        assert!(found < 1e-4, "from {kernel}: {what} differs by {found:.1e}");
    }
}

/// The scene with the ball on the sponge and surface tension. With the models of the paper also a sponge for each of the other solvers:
/// every kernel has work but those of the pressure solve.
fn everything(name: &str, keys: &[&str]) -> Scene {
    let (paper, resolution) = if name.ends_with("_paper") { (true, 0.5) } else { (false, 0.3) };
    let mut scene = busy::scene(name, resolution);
    if let Some(fluid) = &mut scene.fluid {
        fluid.surface_tension = 0.072;
    }
    if let (true, Domain::Box { minimum, maximum, .. }) = (paper, &mut scene.domain) {
        (minimum.x, maximum.x) = (-0.15, 0.15);
    }
    let beside = [(-0.12, "left", Solver::Vbd), (0.06, "right", Solver::XpbdNeoHookean)];
    for (x, name, solver) in beside.into_iter().filter(|_| paper) {
        let (cells, position) = (UVec3::splat(3), Vec3::new(x, 0.0, -0.03));
        let sponge = Sponge { name: name.to_owned(), cells, position, solver, ..scene.sponges[0].clone() };
        scene.sponges.push(sponge);
    }
    common::with(&scene, keys)
}

/// Kernels that run at one place: those that use the cells, and those that are repeated until they have converged.
const TOGETHER: [&[&str]; 4] = [
    &["grid::sort_fluid", "grid::fluid_neighbors", "divergence::images", "couple::controls"],
    &[
        "divergence::update",
        "divergence::acceleration",
        "couple::solid_response",
        "couple::solid_velocity",
        "tets::response",
        "tets::velocity",
        "divergence::residual",
    ],
    &["sph::pressure_update", "sph::pressure_acceleration", "couple::solid_yield", "sph::pressure_residual"],
    &["sph::viscosity_spin", "sph::viscosity_strain", "sph::viscosity_product", "sph::viscosity_update"],
];

/// Kernels of a scene that can be placed separately.
fn placed_alone(world: &World) -> Vec<Vec<&'static str>> {
    let runs = |name: &str| {
        world.plan().lines().iter().any(|line| line.name == name && line.verdict == Verdict::Runs)
    };
    let alone = |name: &&'static str| TOGETHER.iter().all(|group| !group.contains(name));
    let names = KERNELS.iter().map(|kernel| kernel.name).filter(|name| runs(name));
    let mut all: Vec<Vec<_>> = names.filter(alone).map(|name| vec![name]).collect();
    let groups = TOGETHER.iter().map(|group| group.iter().copied().filter(|name| runs(name)).collect());
    all.extend(groups.filter(|group: &Vec<_>| !group.is_empty()));
    all
}

/// The scene whose kernels [`every_kernel_can_be_alone_on_either_side`] places.
fn plain() -> Scene {
    everything("ball_drop_paper", &[])
}

/// Those that the plain scene runs as well are left to it.
#[track_caller]
fn assert_each_further_can_be_alone(scene: &Scene, tolerance: f64) {
    let of_plain = placed_alone(&world(&plain(), Offload::Cpu));
    let names: Vec<_> = placed_alone(&world(scene, Offload::Cpu));
    let further: Vec<_> = names.into_iter().filter(|names| !of_plain.contains(names)).collect();
    assert!(!further.is_empty(), "{}: nothing but what the plain scene runs", scene.name);
    assert_each_can_be_alone(scene, further, tolerance);
}

#[track_caller]
fn assert_each_can_be_alone(scene: &Scene, each: Vec<Vec<&'static str>>, tolerance: f64) {
    let [mut cpu, mut aside] = [scene, &shifted(scene)].map(|scene| world(scene, Offload::Cpu));
    [&mut cpu, &mut aside].into_iter().for_each(|world| common::steps(world, 2));
    let bound = bound(tolerance, difference(&cpu.measures(), &aside.measures()).0);
    // Negative control: gravity that leans is noticed.
    let mut leaning = scene.clone();
    leaning.gravity.x += 5.0;
    let mut other = world(&leaning, Offload::Cpu);
    common::steps(&mut other, 2);
    let control = difference(&cpu.measures(), &other.measures()).0;
    assert!(control > bound, "{control:.1e} of {bound:.1e}");
    for names in each {
        for (alone, others) in [(Place::Gpu, Place::Cpu), (Place::Cpu, Place::Gpu)] {
            let mut list: Vec<_> = KERNELS.iter().map(|kernel| (kernel.name, others)).collect();
            list.extend(names.iter().map(|name| (*name, alone)));
            let mut mixed = world(scene, Offload::Each(list));
            assert!(names.iter().all(|name| mixed.plan().place(name) == alone), "{names:?}");
            common::steps(&mut mixed, 2);
            let (found, what) = difference(&cpu.measures(), &mixed.measures());
            assert!(found < bound, "{names:?} on {alone}: {what} differs by {found:.1e}");
        }
    }
}

#[test]
fn every_kernel_can_be_alone_on_either_side() {
    let each = placed_alone(&world(&plain(), Offload::Cpu));
    assert_each_can_be_alone(&plain(), each, 1e-4);
}

#[test]
fn every_kernel_of_a_pressure_solve_can_be_alone_on_either_side() {
    assert_each_further_can_be_alone(&everything("ball_drop_paper", DFSPH), 1e-4);
}

#[test]
fn every_kernel_of_a_solve_for_the_divergence_can_be_alone_on_either_side() {
    // Rounding decides about one more round of the solve: 1.1e-4 of the momentum with `moments` alone on lavapipe.
    assert_each_further_can_be_alone(&common::with(&busy::scene("water", 0.5), DIVERGENCE_AND_BODIES), 4e-4);
}

#[test]
fn every_kernel_of_porous_media_can_be_alone_on_either_side() {
    assert_each_further_can_be_alone(&everything("ball_drop", &[]), 1e-4);
}

#[test]
fn every_kernel_of_smoothed_coupling_can_be_alone_on_either_side() {
    assert_each_further_can_be_alone(&everything("ball_drop", SMOOTHED), 1e-4);
}

#[test]
fn every_kernel_of_implicit_viscosity_can_be_alone_on_either_side() {
    let mut scene = common::with(&busy::scene("water", 0.4), &[DIVERGENCE_AND_BODIES, HONEY].concat());
    scene.bodies[0].no_slip = true;
    assert_each_further_can_be_alone(&scene, 1e-4);
}

#[test]
fn kernels_can_take_turns() {
    let scene = everything("ball_drop_paper", &[]);
    let mut cpu = world(&scene, Offload::Cpu);
    let list = KERNELS.iter().enumerate().map(|(index, kernel)| {
        let sort = ["grid::sort_fluid", "grid::fluid_neighbors", "couple::controls"].contains(&kernel.name);
        (kernel.name, if sort || index % 2 == 0 { Place::Gpu } else { Place::Cpu })
    });
    let mut mixed = world(&scene, Offload::Each(list.collect()));
    for _ in 0..2 {
        common::frame(&mut cpu);
        common::frame(&mut mixed);
    }
    let (found, what) = difference(&cpu.measures(), &mixed.measures());
    assert!(found < 1e-3, "{what} differs by {found:.1e}");
    // Negative control: a frame more is another state.
    common::frame(&mut mixed);
    assert!(difference(&cpu.measures(), &mixed.measures()).0 > 1e-3);
}

#[test]
fn kernels_at_places_where_they_cannot_be_are_refused() {
    let scene = busy::scene("water", 0.5);
    let error = |list: Vec<(&'static str, Place)>| {
        let options = Options { offload: Offload::Each(list), gpu: Some(gpu()), ..Options::default() };
        World::with_options(&scene, &options).map(|_| ()).map_err(|error| error.to_string())
    };
    let sort = ("grid::sort_fluid", Place::Gpu);
    let refused = error(vec![sort]);
    assert!(refused.as_ref().is_err_and(|text| text.contains("grid::fluid_neighbors=cpu")), "{refused:?}");
    let search = [sort, ("grid::fluid_neighbors", Place::Gpu), ("divergence::images", Place::Gpu)];
    assert_eq!(error(search.to_vec()), Ok(()));
    let solved = common::with(&scene, DFSPH);
    let options = |list| Options { offload: Offload::Each(list), gpu: Some(gpu()), ..Options::default() };
    let apart =
        World::with_options(&solved, &options(vec![("sph::pressure_update", Place::Gpu)])).map(|_| ());
    let apart = apart.map_err(|error| error.to_string());
    assert!(
        apart.as_ref().is_err_and(|text| text.contains("sph::pressure_residual=cpu")
            || text.contains("sph::pressure_acceleration=cpu")),
        "{apart:?}"
    );
    let unknown = error(vec![("sph::nothing", Place::Gpu)]);
    assert!(unknown.as_ref().is_err_and(|text| text.contains("sph::nothing")), "{unknown:?}");
}

#[test]
fn plans_say_where_and_why_and_what_travels() {
    let scene = busy::scene("ball_drop_paper", 0.3);
    let all = world(&scene, Offload::Gpu).plan().to_string();
    for part in ["backend gpu", "gpu   sph::density", "host  rigid::step", "send  bodies.states: 224 bytes"] {
        assert!(all.contains(part), "{part} is not in {all}");
    }
    let mixed = world(&scene, Offload::From("sph::forces")).plan().to_string();
    for part in ["cpu   sph::density", "gpu   sph::forces", "send ", "fetch "] {
        assert!(mixed.contains(part), "{part} is not in {mixed}");
    }
    let list = vec![("pbd::strain", Place::Gpu), ("pbd::contact", Place::Cpu)];
    let each = world(&scene, Offload::Each(list)).plan().to_string();
    for part in [
        "gpu   1 x pbd::strain",
        "cpu   1 x pbd::contact",
        "send  nodes.position, nodes.predicted: ",
        "fetch nodes.predicted: ",
    ] {
        assert!(each.contains(part), "{part} is not in {each}");
    }
    let few = world(&scene, Offload::Auto).plan().to_string();
    assert!(few.contains("backend cpu, of auto") && few.contains("worth a GPU"), "{few}");
    assert!(!world(&scene, Offload::Cpu).plan().to_string().contains("backend"));
}

/// With the limits that every adapter has, so that the text is the same everywhere.
#[test]
fn plans_say_how_many_dispatches_a_step_takes() {
    let limits = wgpu::Limits::default();
    let small = gpu::adapters().into_iter().next().map(|adapter| Gpu::with_limits(&adapter, limits));
    let Some(Ok(small)) = small else { panic!("no adapter with the limits of WebGPU: {small:?}") };
    let small = Arc::new(small.with_busy_threads(Gpu::BUSY_THREADS));
    let dispatches = |name: &str, offload: Offload| {
        let options = Options { offload, gpu: Some(Arc::clone(&small)), ..Options::default() };
        let world = World::with_options(&busy::scene(name, 0.5), &options).expect("a scene of the tests");
        internal::dispatches(&world).expect("there is enough memory")
    };
    for name in ["ball_drop", "water"] {
        let all = dispatches(name, Offload::Gpu).expect("dispatches of a world on a device");
        common::golden(&format!("dispatches_{name}"), &all.to_string());
        let of_rounds: usize = all.rounds.iter().map(|(passes, rounds)| passes * *rounds as usize).sum();
        assert_eq!(all.total(), all.once + of_rounds);
    }
    let part = dispatches("water", Offload::Each(vec![("sph::forces", Place::Gpu)]));
    let names = part.expect("dispatches of a part of a step").kernels;
    assert_eq!(names.iter().map(|own| own.kernel).collect::<Vec<_>>(), ["sph::forces", "clock"]);
    assert_eq!(dispatches("water", Offload::Cpu), None);
}
