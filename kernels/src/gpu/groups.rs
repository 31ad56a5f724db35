//! Threads of the groups of a pass.

use super::layout::{ROW, ROW_BYTES};
use crate::layout::constants;

constants! {
    /// Threads of a group.
    pub(super) const GROUP_THREADS: u32 = 256;
    /// Threads that share the particles of a control.
    pub(super) const CONTROL_THREADS: u32 = 32;
    /// Controls of a group.
    pub(super) const CONTROLS_PER_GROUP: u32 = GROUP_THREADS / CONTROL_THREADS;
    /// Threads of a group for each sponge.
    pub(super) const SPONGE_THREADS: u32 = 256;
    /// Rows of a wrench: impulse and angular impulse.
    pub(super) const WRENCH_ROWS: u32 = 2;
    /// Rows of the sums of a group in a pressure solve.
    pub(super) const SOLVE_SUM_ROWS: u32 = 2;
    /// Rows of the box around a sponge: its corners.
    pub(super) const BOX_ROWS: u32 = 2;
    /// Rows of the motion of a sponge: centre, velocity and angular velocity.
    pub(super) const MOTION_ROWS: u32 = 3;
    /// Rows of the sums over a part of a sponge.
    pub(super) const SUM_ROWS: u32 = 5;
}

/// Nodes of a part of a sponge: eight for every thread.
const PART_NODES: usize = 8 * SPONGE_THREADS as usize;
/// Parts from which on they save more than the second pass takes. On an H200 five parts take 42 us and one
/// group 37, 33 parts 62 and 361.
const MINIMUM_PARTS: usize = 7;

/// Parts into which the nodes of every sponge are divided, in a scene with this many nodes: one in scenes of few parts. A second pass adds
/// up the parts.
pub(crate) fn sponge_parts(nodes: usize) -> usize {
    let parts = nodes.div_ceil(PART_NODES);
    if parts < MINIMUM_PARTS { 1 } else { parts }
}

/// Rows of the motions of sponges, and of the sums over their parts if there are several.
pub(super) fn motion_rows(sponges: usize, nodes: usize) -> usize {
    let parts = sponge_parts(nodes);
    let sums = if parts > 1 { parts * SUM_ROWS as usize } else { 0 };
    sponges * (MOTION_ROWS as usize + sums)
}

/// Threads of a group where there are fewer rows than keep a device busy in groups of [`GROUP_THREADS`].
const SMALL_GROUP_THREADS: u32 = 64;
/// Rows from which on groups are not small.
const SMALL_GROUP_ROWS: u64 = 65_536;
/// Threads that keep a hardware adapter busy.
pub(super) const BUSY_THREADS: u64 = 131_072;
/// Most threads that share a row.
const MAXIMUM_SHARES: u64 = 16;

/// Threads of a group of a pass over this many rows.
pub(super) const fn group_of(rows: u64) -> u32 {
    if rows < SMALL_GROUP_ROWS { SMALL_GROUP_THREADS } else { GROUP_THREADS }
}

/// Threads that share a row of a pass over this many rows, where so many keep the device busy: a power of two.
pub(super) fn shares_of(rows: u64, busy_threads: u64) -> u32 {
    let shares = (busy_threads / rows.max(1)).clamp(1, MAXIMUM_SHARES);
    1 << shares.ilog2()
}

/// Groups of a pass over this many rows.
pub(super) const fn groups_of(rows: usize) -> usize {
    rows.div_ceil(GROUP_THREADS as usize)
}

/// Most groups of a pass over this many rows: groups are small where there are few rows, and several threads share one.
pub(super) fn maximum_groups(rows: u64, busy_threads: u64) -> u64 {
    let rows_of_group = group_of(rows) / shares_of(rows, busy_threads);
    rows.div_ceil(u64::from(rows_of_group))
}

/// Bytes of the wrenches on bodies: one for every body and group of a pass over this many rows.
pub(super) const fn wrench_bytes(rows: usize, bodies: usize) -> usize {
    groups_of(rows) * bodies * rows_bytes(WRENCH_ROWS) as usize
}

/// Floats of a wrench.
pub(super) const WRENCH_FLOATS: usize = WRENCH_ROWS as usize * ROW;

/// Bytes of rows.
pub(super) const fn rows_bytes(rows: u32) -> u64 {
    rows as u64 * ROW_BYTES
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_of_a_row_are_a_part_of_a_group_and_keep_a_device_busy() {
        let shares =
            [1, 8_192, 16_384, 32_768, 65_536, 131_072, 4_000_000].map(|rows| shares_of(rows, BUSY_THREADS));
        assert_eq!(shares, [16, 16, 8, 4, 2, 1, 1]);
        for rows in (0..200_000).step_by(997) {
            let (group, shares) = (group_of(rows), shares_of(rows, BUSY_THREADS));
            assert!(shares.is_power_of_two() && group % shares == 0, "{rows}");
            assert!(shares == 1 || rows * u64::from(shares) <= BUSY_THREADS, "{rows}");
            assert_eq!(shares_of(rows, 0), 1);
        }
    }
}
