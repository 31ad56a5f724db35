// Stores the sums of a workgroup among those of all workgroups.
fn write_sums(group: u32, lane: u32, sums: Sums) {
    if (lane != 0u || group * 5u + 4u >= arrayLength(&partial_sums)) {
        return;
    }
    let first = group * 5u;
    partial_sums[first] = sums.a;
    partial_sums[first + 1u] = sums.b;
    partial_sums[first + 2u] = sums.c;
    partial_sums[first + 3u] = sums.d;
    partial_sums[first + 4u] = sums.largest;
}
