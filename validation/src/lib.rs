//! How far `sorb` is from what is known: analytic solutions, experiments, and converged solves of the same equations.
//!
//! A [`Case`] builds a scene through the public API of `sorb`, runs it, and gives [`Figure`]s: a measured value, its
//! reference, the error in a stated norm, and the bound that the error must keep. A case can plant a fault
//! ([`Setting::fault`]), which must push it out of its bounds: a case that passes with the fault proves nothing.
//!
//! References are computed here, in f64, apart from the simulator: [`fem`] solves the elastic problems on the
//! simulator's own tets, [`references`] holds tables and formulas with their sources.

mod case;
mod cases;
pub mod fem;
mod known;
mod level;
pub mod norms;
pub mod precision;
pub mod references;
mod run;
mod solver;

pub use case::{Backends, Case, Failure, Figure, Setting, Stopwatch, Subject, Verdict};
pub use cases::CASES;
pub use known::{KNOWN_MISSES, KnownMiss};
pub use run::{Outcome, run};
pub use solver::{Material, SolverKind, Solvers};
