//! Tables and formulas with their sources.

pub mod floating;
pub mod martin_moyce;
