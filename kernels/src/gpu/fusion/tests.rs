//! Which passes are one dispatch, and the texts of those.

use std::sync::Arc;

use wgpu::naga::{
    front::wgsl::parse_str,
    valid::{Capabilities, ValidationFlags, Validator},
};

use super::{access::order, *};
use crate::{
    KERNELS,
    gpu::{
        Gpu, Resident,
        device::required_limits,
        jobs::Jobs,
        twins::{Pass, pass},
        wgsl::complete,
    },
    stage::Stage,
    tests::{
        gpu::LIMITS,
        scene::{FULL, Options, Scene},
    },
};

/// What a device has of a scene.
fn resident(options: Options) -> Resident {
    let scene = Scene::new(options);
    let adapter = crate::gpu::adapters().into_iter().next().expect("there is an adapter");
    let gpu = Gpu::with_limits(&adapter, required_limits(&adapter)).expect("the adapter gives a device");
    let gpu = gpu.with_busy_threads(Gpu::BUSY_THREADS);
    Resident::new(&Arc::new(gpu), &scene.columns, &scene.params, LIMITS).expect("there is enough memory")
}

/// Dispatches of all kernels, in the order of the table.
fn of_kernels(resident: &Resident, limits: Option<&Limits>) -> Vec<Dispatched> {
    let stages: Vec<Stage> = KERNELS.iter().map(|kernel| Stage::Run(kernel)).collect();
    let jobs = resident.jobs_of(&stages);
    jobs.iter().map(Jobs::jobs).flat_map(|jobs| dispatched(jobs, limits)).collect()
}

fn order_of(before: &Pass, after: &Pass) -> Order {
    let of = |pass: &Pass| {
        sorb_shaders::shader(pass.shader).map(|shader| accesses(pass, shader)).unwrap_or_default()
    };
    order(&of(before), &of(after))
}

#[test]
fn passes_are_ordered_by_what_they_do_to_buffers() {
    let fluid = |name| pass(name, Rows::Fluid);
    for (before, after, expected) in [
        ("divergence::rate", "divergence::rate_images", Order::ByRow),
        ("divergence::rate_images", "divergence::residual", Order::ByRow),
        ("divergence::update", "divergence::acceleration", Order::Whole),
        ("divergence::acceleration", "divergence::update", Order::Whole),
        ("divergence::reflect", "divergence::rate_images", Order::Whole),
        ("grid::sort_fluid", "grid::fluid_neighbors", Order::Whole),
        ("couple::near_fluid", "grid::fluid_neighbors", Order::Any),
        ("sph::forces", "couple::interior", Order::Any),
    ] {
        assert_eq!(order_of(&fluid(before), &fluid(after)), expected, "{before} {after}");
    }
    let [count, scatter] = ["grid::count", "grid::scatter"].map(fluid);
    let names = crate::gpu::twins::FLUID_CELLS;
    let others = crate::gpu::twins::CONTROL_CELLS;
    assert_eq!(order_of(&count.on(names), &scatter.on(others)), Order::Any, "other buffers");
    assert_eq!(order_of(&count.on(names), &scatter.on(names)), Order::Whole);
}

/// What is wrong with the text of a dispatch.
fn fault(own: &Dispatched) -> Option<String> {
    let (name, Fused { text, .. }) = (own.names(), Fused::of(own)?);
    let text = complete(&text);
    let module = match parse_str(&text) {
        Ok(module) => module,
        Err(error) => return Some(format!("{name}: {}", error.emit_to_string(&text))),
    };
    let valid = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module);
    valid.err().map(|error| format!("{name}: {error:?}"))
}

/// The variable `row` is the row of the thread, by which passes are told to be of the same rows.
#[test]
fn rows_of_threads_have_their_name() {
    let meant = [
        "row_of(group, groups, lane)",
        "share.row",
        "control_row(group, groups, lane)",
        "group_of(group, groups) * CONTROLS_PER_GROUP + lane / CONTROL_THREADS",
    ];
    let mut seen = 0;
    for pass in KERNELS.iter().flat_map(|kernel| kernel.twin) {
        let is_of_rows = matches!(
            pass.rows,
            Rows::Fluid
                | Rows::FluidBesideBodies
                | Rows::Nodes
                | Rows::Controls
                | Rows::Images
                | Rows::ImagesOfBodies
                | Rows::Tets
        );
        let text = sorb_shaders::shader(pass.shader).map_or("", |shader| shader.own);
        for line in text.lines().filter(|_| is_of_rows).map(str::trim) {
            let declared = line.strip_prefix("let row = ").or_else(|| line.strip_prefix("var row = "));
            let Some(value) = declared else { continue };
            assert!(meant.contains(&value.trim_end_matches(';')), "{}: {line}", pass.shader);
            seen += 1;
        }
        for (before, after) in occurrences(text, "row").filter(|_| is_of_rows) {
            let is_parameter = after.starts_with(": u32") && !before.trim_end().ends_with("var<private>");
            let calls = ["reflected", "insert"].iter().any(|name| before.ends_with(&format!("fn {name}(")));
            assert!(!is_parameter || calls, "{}: a parameter of this name may be another row", pass.shader);
        }
    }
    assert!(seen > 80, "{seen}");
}

#[test]
fn texts_of_several_passes_are_valid() {
    for options in [
        FULL,
        Options { incompressible: true, ..FULL },
        Options { incompressible: true, divergence: true, ..FULL },
        Options { incompressible: true, divergence: true, sponges: false, ..FULL },
    ] {
        let resident = resident(options);
        let limits = &resident.gpu.limits;
        let (all, alone) = (of_kernels(&resident, Some(limits)), of_kernels(&resident, None));
        let passes = |all: &[Dispatched]| all.iter().map(|own| own.jobs().count()).sum::<usize>();
        assert_eq!(passes(&all), passes(&alone));
        assert!(4 * all.len() < 3 * alone.len(), "{} of {}", all.len(), alone.len());
        let small = Limits { max_storage_buffers_per_shader_stage: 8, ..limits.clone() };
        let few = of_kernels(&resident, Some(&small));
        assert!(all.len() < few.len() && few.len() < alone.len(), "{} {}", all.len(), few.len());
        let several = all.iter().chain(&few).filter(|own| own.single().is_none());
        assert_eq!(several.filter_map(fault).collect::<Vec<_>>(), Vec::<String>::new());
        for own in &few {
            let storage =
                text::bindings_of(own).map(|all| all.iter().filter(|binding| binding.is_storage()).count());
            assert!(own.single().is_some() || storage.is_some_and(|storage| storage <= 8), "{}", own.names());
        }
    }
}
