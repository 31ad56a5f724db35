//! Parts of a step: a kernel, or kernels that are repeated until they have converged.

use crate::{
    columns::Columns,
    kernel::{Kernel, has_converged},
};

/// One stage of a step.
#[derive(Clone, Debug)]
pub enum Stage {
    /// A kernel.
    Run(&'static Kernel),
    /// Kernels that are repeated until they have converged. A device finds out on its own.
    Rounds {
        /// Most rounds; at least 1.
        maximum: u32,
        /// What is repeated.
        kernels: Vec<&'static Kernel>,
    },
}

impl Stage {
    /// Its kernels, in order.
    #[must_use]
    pub fn kernels(&self) -> &[&'static Kernel] {
        match self {
            Self::Run(kernel) => std::slice::from_ref(kernel),
            Self::Rounds { kernels, .. } => kernels,
        }
    }

    /// Runs it: calls `run` with the place of a kernel in [`Self::kernels`] and the kernel, until they have converged.
    pub fn run(&self, columns: &mut Columns, mut run: impl FnMut(usize, &'static Kernel, &mut Columns)) {
        let rounds = match self {
            Self::Run(_) => 1,
            Self::Rounds { maximum, .. } => *maximum,
        };
        for _ in 0..rounds {
            for (index, kernel) in self.kernels().iter().enumerate() {
                run(index, kernel, columns);
            }
            if self.kernels().iter().all(|kernel| has_converged(kernel, columns)) {
                break;
            }
        }
    }
}
