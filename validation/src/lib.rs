//! Comparison of `sorb` with analytic solutions, experiments, and converged solutions of the same equations.
//!
//! A [`Case`] builds a scene through the public API of `sorb`, runs it, and returns [`Figure`]s. A figure has a measured
//! value, its reference, the error in a stated norm, and its bound. A case can plant a fault ([`Setting::fault`]), which
//! must push it out of its bounds: a case that passes with the fault proves nothing.
//!
//! References are computed here, in f64, independently of the simulator. [`fem`] solves the elastic problems on the
//! simulator's own tets, and [`references`] has tables and formulas with their sources.

mod case;
mod cases;
pub mod convergence;
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
