//! Sums of measures in the buffers of a device.

use super::groups::groups_of;
use crate::{
    columns::RowCounts,
    layout::{constants, layout},
};

layout! {
    /// Sums of one group, or of all; what they are is said where they are made.
    #[derive(Clone, Copy, Debug)]
    pub(super) struct GroupSums {
        pub(super) a: [f32; 4],
        pub(super) b: [f32; 4],
        pub(super) c: [f32; 4],
        pub(super) d: [f32; 4],
        /// Largest values.
        pub(super) largest: [f32; 4],
    }
}

constants! {
    /// What stands for the largest of no values.
    pub(super) const NO_VALUE: f32 = -3.0e38;
}

/// Groups of the largest of the stores that are summed up.
pub(super) fn sum_groups(rows: RowCounts) -> u64 {
    groups_of(rows.fluid.max(rows.nodes).max(rows.tets)) as u64
}
