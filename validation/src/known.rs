//! Figures that the present models cannot bring into bounds, with the cause.

/// A figure that is known to be out of bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KnownMiss {
    /// Name of the case.
    pub case: &'static str,
    /// Part of the names of the solvers; empty for all.
    pub solver: &'static str,
    /// Beginning of the name of the figure; empty for all of the case.
    pub figure: &'static str,
    /// Why.
    pub cause: &'static str,
}

/// All of them.
pub const KNOWN_MISSES: &[KnownMiss] = &[];

pub(crate) fn known(case: &str, solver: &str, figure: &str) -> Option<&'static KnownMiss> {
    KNOWN_MISSES
        .iter()
        .find(|miss| miss.case == case && solver.contains(miss.solver) && figure.starts_with(miss.figure))
}
