//! What twins read and write is what their kernels declare. Needs no adapter.

use std::collections::BTreeSet;

use crate::{
    KERNELS,
    columns::Column,
    gpu::{
        twins::Pass,
        wgpu::naga::{
            front::wgsl,
            valid::{Capabilities, GlobalUse, ValidationFlags, Validator},
        },
    },
    kernel::{Kernel, TwinAccess},
};

/// The columns that are in a buffer; none for what is no column, such as parameters, the clock and partial sums.
fn columns_in(buffer: &str) -> Vec<Column> {
    let plain = buffer.strip_suffix("_next").unwrap_or(buffer);
    let cells = ["grid", "cells", "slots", "counts", "starts", "page_sums", "grouped"];
    let of_cells = |store: &str| cells.iter().any(|part| buffer == format!("{store}_{part}"));
    match buffer {
        "extremes" => vec![Column::FluidExtremes, Column::NodeExtremes],
        "node_stars" => vec![
            Column::NodeStars,
            Column::NodeSponge,
            Column::NodeWetting,
            Column::NodeTouch,
            Column::NodeTouchStiffness,
            Column::NodeTouchBetween,
        ],
        "node_traits" => vec![Column::NodeSponge, Column::NodeSuction, Column::NodeInterior],
        "tets" | "tet_weight" | "tet_sponge" => vec![Column::NodeTopology],
        "planes" => vec![Column::BodyStates],
        "images" | "image_position" | "image_order" | "image_particles" | "fluid_near_images"
        | "fluid_image_first" | "image_line_counts" | "image_line_sums" => vec![Column::FluidImages],
        _ if of_cells("image") => vec![Column::FluidImages],
        _ if of_cells("fluid") => vec![Column::FluidCells],
        _ if of_cells("control") => vec![Column::ControlCells],
        _ => Column::ALL.iter().copied().filter(|column| column.buffer() == plain).collect(),
    }
}

/// Buffers that a pass reads and writes, by name.
fn accesses(pass: &Pass, source: &str) -> Vec<(&'static str, GlobalUse)> {
    let module = wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}: {error}", pass.shader));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::all());
    let info = validator.validate(&module).unwrap_or_else(|error| panic!("{}: {error}", pass.shader));
    let entry = module.entry_points.iter().position(|entry| entry.name == pass.entry);
    let entry = entry.unwrap_or_else(|| panic!("{} has no `{}`", pass.shader, pass.entry));
    let uses = info.get_entry_point(entry);
    let bindings = crate::gpu::bindings(sorb_shaders::shader(pass.shader).map_or("", |shader| shader.source));
    let globals = module.global_variables.iter().filter(|(_, variable)| variable.binding.is_some());
    globals
        .filter_map(|(handle, variable)| {
            let name = variable.name.as_deref()?;
            let variable = bindings.iter().copied().find(|binding| *binding == name)?;
            Some((pass.buffer(variable), uses[handle]))
        })
        .collect()
}

/// What a kernel's twin does that the kernel does not declare.
fn undeclared(kernel: &Kernel, declared: &TwinAccess) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut written: Vec<Column> = Vec::new();
    for pass in kernel.twin {
        let shader = sorb_shaders::shader(pass.shader).unwrap_or_else(|| panic!("no {}", pass.shader));
        let accesses = accesses(pass, &crate::gpu::complete(shader.source));
        for (buffer, access) in &accesses {
            if access.contains(GlobalUse::WRITE) {
                written.extend(columns_in(buffer));
            }
        }
        for (buffer, access) in accesses {
            let columns = columns_in(buffer);
            let has = |list: &[Column]| columns.iter().any(|column| list.contains(column));
            if columns.is_empty() {
                continue;
            }
            let is_own = has(kernel.writes) && has(&written) || has(declared.writes) && has(&written);
            if access.contains(GlobalUse::READ) && !(has(kernel.reads) || has(declared.reads) || is_own) {
                found.insert(format!("{} reads {buffer}", kernel.name));
            }
            if access.contains(GlobalUse::WRITE) && !(has(kernel.writes) || has(declared.writes)) {
                found.insert(format!("{} writes {buffer}", kernel.name));
            }
        }
    }
    found
}

#[test]
fn twins_read_and_write_what_is_declared() {
    let all: Vec<String> =
        KERNELS.iter().flat_map(|kernel| undeclared(kernel, &kernel.twin_access)).collect();
    assert!(all.is_empty(), "{}", all.join("\n"));
}

/// The control, and the way to see that no exception is left over.
#[test]
fn every_exception_is_needed() {
    for kernel in KERNELS {
        let TwinAccess { reads, writes } = kernel.twin_access;
        for column in reads.iter().chain(writes) {
            let without =
                |list: &[Column]| list.iter().copied().filter(|other| other != column).collect::<Vec<_>>();
            let (reads, writes) = (without(reads), without(writes));
            let found = undeclared(kernel, &TwinAccess { reads: reads.leak(), writes: writes.leak() });
            assert!(!found.is_empty(), "{} does not need {}", kernel.name, column.name());
        }
    }
}

#[test]
fn a_kernel_that_does_not_declare_is_found() {
    let density = crate::kernel_named("sph::density").expect("there is one");
    let plain = |reads, writes| Kernel { reads, writes, ..*density };
    let none = TwinAccess { reads: &[], writes: &[] };
    assert!(undeclared(&plain(density.reads, density.writes), &none).is_empty());
    let found = undeclared(&plain(&[Column::FluidNeighbors], density.writes), &none);
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["sph::density reads fluid_position"]);
    let found = undeclared(&plain(density.reads, &[]), &none);
    assert_eq!(found.into_iter().collect::<Vec<_>>(), ["sph::density writes fluid_density"]);
}
