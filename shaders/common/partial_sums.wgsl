// The sums of a group to its place among those of all groups.
fn write_sums(group: u32, lane: u32, sums: GroupSums) {
    if (lane == 0u && group < arrayLength(&partial_sums)) {
        partial_sums[group] = sums;
    }
}
