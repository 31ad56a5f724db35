//! Kernels on a GPU, through wgpu.
//!
//! A [`Gpu`] is a device with the pipelines compiled for it; it can be shared, and it can be the host's. A [`Resident`]
//! holds the columns of one world on it. A [`Program`] is a list of kernels bound to those columns. State stays on the
//! device. [`Resident::advance`] takes many steps in one submission and gives back a few hundred bytes, because the
//! device chooses the length of the steps itself.
//!
//! # Determinism
//! The same device gives the same bits on every run. There are no atomics on floats, sums have a fixed order, and the
//! sort is stable. Another device, or the CPU, gives other bits within the bounds of the parity tests.
//!
//! # What differs from the CPU
//! Lists of neighbours are one row of the k-th neighbours of all particles after the other. Weights of the coupling
//! are computed where they are needed and not kept; the search for neighbours sums up the density. The columns mean
//! the same.

mod answer;
mod bodies;
mod capacities;
mod cells;
mod compile;
mod device;
mod dispatches;
mod error;
mod facts;
mod form;
mod fusion;
mod groups;
mod image_layout;
mod images;
mod jobs;
pub(crate) mod layout;
mod lists;
mod pack;
mod pipeline;
mod profile;
mod program;
mod query;
mod query_layout;
mod read;
mod renew;
mod resident;
#[cfg(test)]
mod rounds;
mod run;
mod stars;
mod subgroups;
mod sum_layout;
mod sums;
mod transfer;
mod turn;
pub(crate) mod twins;
mod vectors;
mod wgsl;

pub use answer::{Answer, CLOCK_BYTES, Outcome, Start};
pub use bodies::{BODY_BYTES, ShapeKind};
pub use device::{AdapterReport, Gpu, adapters, required_features, required_limits};
pub use dispatches::{Dispatches, KernelDispatches};
pub use error::GpuError;
#[cfg(test)]
pub(crate) use groups::sponge_parts;
pub use pipeline::{Binding, Pipeline};
pub use profile::Profile;
pub use program::Program;
pub use query::{SpongeValues, WaterHit, WaterShares, WaterSums};
pub use query_layout::SURFACE_SHARE;
pub use read::Pending;
pub use resident::Resident;
pub use sorb_shaders as shaders;
pub use sums::{FluidSums, NodeSums, Sums, TetSums};
pub use transfer::{column_bytes, make_room};
pub use wgpu;

/// Most sponges of a scene on a device.
pub const MAXIMUM_SPONGES: usize = pack::SPONGES;
#[cfg(test)]
pub(crate) use wgsl::complete;

/// Names of the variables that a text binds.
#[cfg(test)]
pub(crate) fn bindings(source: &'static str) -> Vec<&'static str> {
    pipeline::bindings(source).into_iter().map(|binding| binding.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{KERNELS, kernel::Kernel};

    #[test]
    fn every_kernel_has_passes() {
        for kernel in KERNELS {
            assert!(!kernel.twin.is_empty(), "{}", kernel.name);
        }
        // Negative control: one without any.
        assert!(Kernel::bare("test::none", &[], &[], &[], |_, _, _| {}).twin.is_empty());
    }

    #[test]
    fn every_shader_is_used_and_binds_at_most_eight_storage_buffers() {
        let helpers = [
            twins::BEGIN,
            twins::BODY_WRENCHES,
            twins::END_ROUNDS,
            twins::FINISH,
            twins::QUERY_POINTS,
            twins::QUERY_RAYS,
            twins::QUERY_SPONGES,
            twins::RESUME,
            twins::SUMS[0],
            twins::SUMS[1],
            twins::SUMS[2],
            twins::TOTAL,
            twins::TURN_NODES,
            twins::TURN_PARTICLES,
        ];
        let passes: Vec<_> = KERNELS.iter().flat_map(|kernel| kernel.twin).chain(&helpers).collect();
        for shader in sorb_shaders::SHADERS.iter().chain(sorb_shaders::SUBGROUP_SHADERS) {
            assert!(passes.iter().any(|pass| pass.shader == shader.name), "{}", shader.name);
            let bindings = pipeline::bindings(shader.source);
            let storage = bindings.iter().filter(|binding| binding.is_storage()).count();
            assert!((1..=8).contains(&storage), "{}: {storage}", shader.name);
            // Mesa 22.3's lavapipe has crashed with four: see docs/gpu.md.
            assert!(bindings.len() - storage <= 3, "{}: uniform buffers", shader.name);
            let declared = shader.source.matches("@binding(").count();
            assert_eq!(
                declared,
                bindings.len(),
                "{}: a binding that is not on a line of its own",
                shader.name
            );
            for (index, binding) in bindings.iter().enumerate() {
                assert_eq!(binding.index, index as u32, "{}", shader.name);
            }
        }
        for pass in passes {
            assert!(sorb_shaders::shader(pass.shader).is_some(), "{}", pass.shader);
        }
    }

    #[test]
    fn every_pass_leaves_when_nothing_is_to_be_done() {
        for kernel in KERNELS {
            for pass in kernel.twin {
                let source = sorb_shaders::shader(pass.shader).map_or("", |shader| shader.source);
                assert!(source.contains("clock.running == 0u"), "{}: {}", kernel.name, pass.shader);
            }
        }
    }
}
