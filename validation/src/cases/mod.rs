//! The cases, in the order in which they are listed and run.

mod dam_break;
mod floating;
mod hydrostatic;

use crate::case::Case;

/// All cases.
pub const CASES: &[&Case] = &[&hydrostatic::CASE, &dam_break::CASE, &floating::CASE];
