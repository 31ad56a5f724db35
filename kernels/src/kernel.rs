//! A kernel: its declaration, and its body for the CPU.

#[cfg(feature = "gpu")]
use crate::gpu::{layout::Constant, twins::Pass};
use crate::{
    columns::{Column, Columns},
    cpu::Cpu,
    params::Params,
};

pub use crate::need::Need;

/// Columns that only the twin of a kernel reads or writes.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwinAccess {
    #[cfg(test)]
    pub(crate) reads: &'static [Column],
    pub(crate) writes: &'static [Column],
}

/// A kernel as a plain loop in f64.
pub type Oracle = fn(&Params, &mut Columns);

/// One phase of a step: a declaration and a body, by `declare!`. The same name is used for its path, its WGSL twin, its
/// bench and its line in a plan.
#[derive(Debug)]
pub struct Kernel {
    /// `family::name`.
    pub name: &'static str,
    /// What the scene must contain; all of these.
    pub needs: &'static [Need],
    /// Columns whose content before the kernel matters.
    pub reads: &'static [Column],
    /// Columns that the kernel changes.
    pub writes: &'static [Column],
    /// The body for the CPU.
    pub cpu: fn(&Cpu, &Params, &mut Columns),
    /// The same as a plain loop in f64, see [`crate::oracle`].
    #[cfg(any(test, feature = "oracles"))]
    pub oracle: Oracle,
    /// Largest error of a column against the oracle, over the scale of its changes.
    ///
    /// Rounding to f32 is 6e-8 of a value. Sums of tens of terms and the Tait equation (seventh power) lose slightly more.
    /// Displacements of nodes are differences of positions that are a hundred times larger. Each bound is about four times
    /// the measured error.
    #[cfg(test)]
    pub(crate) bound: f64,
    /// Largest error of the twin against the body for the CPU. As [`Self::bound`], except for sums in another order. The CPU
    /// sums the 7000 particles of a node in the largest scene one after the other, a twin in thirty-two parts.
    #[cfg(all(test, feature = "gpu"))]
    pub(crate) twin_bound: f64,
    /// Columns that the twin reads and writes beyond [`Self::reads`] and [`Self::writes`].
    #[cfg(feature = "gpu")]
    pub(crate) twin_access: TwinAccess,
    /// The passes of the WGSL twin, in order.
    #[cfg(feature = "gpu")]
    pub(crate) twin: &'static [Pass],
    /// Constants of its own that the twin knows.
    #[cfg(feature = "gpu")]
    pub(crate) constants: &'static [Constant],
}

impl Kernel {
    /// A kernel with neither oracle nor twin, for tests of plans.
    #[must_use]
    pub const fn bare(
        name: &'static str,
        needs: &'static [Need],
        reads: &'static [Column],
        writes: &'static [Column],
        cpu: fn(&Cpu, &Params, &mut Columns),
    ) -> Self {
        Self {
            name,
            needs,
            reads,
            writes,
            cpu,
            #[cfg(any(test, feature = "oracles"))]
            oracle: |_, _| {},
            #[cfg(test)]
            bound: 0.0,
            #[cfg(all(test, feature = "gpu"))]
            twin_bound: 0.0,
            #[cfg(feature = "gpu")]
            twin_access: TwinAccess {
                #[cfg(test)]
                reads: &[],
                writes: &[],
            },
            #[cfg(feature = "gpu")]
            twin: &[],
            #[cfg(feature = "gpu")]
            constants: &[],
        }
    }
}

/// Declares the kernel of a module, `KERNEL`, with the path of the module for a name. The body is the function `cpu` of the module;
/// `oracle` is the path of a function, `twin` a list of [`Pass`]es, `constants` what `constants!` takes.
macro_rules! declare {
    (
        needs: [$($need:ident$(($solver:ident))?),* $(,)?],
        reads: [$($read:ident),* $(,)?],
        writes: [$($write:ident),* $(,)?],
        oracle: $oracle:path,
        bound: $bound:literal,
        $(twin_bound: $twin_bound:literal,)?
        $(twin_reads: [$($twin_read:ident),* $(,)?],)?
        $(twin_writes: [$($twin_write:ident),* $(,)?],)?
        twin: [$($pass:expr),* $(,)?],
        $(constants: { $($constants:tt)* },)?
    ) => {
        $($crate::layout::constants! { $($constants)* })?

        /// Path of the module within the package.
        const NAME: &str = module_path!().split_at("sorb_kernels::".len()).1;

        /// The declaration.
        pub static KERNEL: $crate::kernel::Kernel = $crate::kernel::Kernel {
            name: NAME,
            needs: &[$($crate::kernel::Need::$need$(($crate::params::Solver::$solver))?),*],
            reads: &[$($crate::columns::Column::$read),*],
            writes: &[$($crate::columns::Column::$write),*],
            cpu,
            #[cfg(any(test, feature = "oracles"))]
            oracle: $oracle,
            #[cfg(test)]
            bound: $bound,
            #[cfg(all(test, feature = "gpu"))]
            twin_bound: $crate::kernel::declare!(@first $($twin_bound,)? $bound),
            #[cfg(feature = "gpu")]
            twin_access: $crate::kernel::TwinAccess {
                #[cfg(test)]
                reads: &[$($($crate::columns::Column::$twin_read),*)?],
                writes: &[$($($crate::columns::Column::$twin_write),*)?],
            },
            #[cfg(feature = "gpu")]
            twin: {
                use $crate::gpu::twins::{Rows::*, *};
                &[$($pass),*]
            },
            #[cfg(feature = "gpu")]
            constants: $crate::kernel::declare!(@constants $({ $($constants)* })?),
        };
    };
    (@constants) => { &[] };
    (@constants { $($constants:tt)* }) => { CONSTANTS };
    (@first $first:literal $(, $rest:literal)?) => { $first };
}
pub(crate) use declare;

/// Whether the solves that a kernel writes to have converged.
#[must_use]
pub fn has_converged(kernel: &Kernel, columns: &Columns) -> bool {
    kernel.writes.iter().all(|column| match column {
        Column::FluidPressureSolve => columns.fluid.pressure_solve.is_converged(),
        Column::FluidViscositySolve => columns.fluid.viscosity_solve.is_converged(),
        _ => true,
    })
}
