// #include sums
// The sums of all workgroups of one of the other passes, in a fixed order.

@group(0) @binding(0) var<uniform> summands: Summands;
@group(0) @binding(1) var<storage, read> partial_sums: array<GroupSums>;
@group(0) @binding(2) var<storage, read_write> totals: array<GroupSums>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    var own = no_sums();
    for (var group = lane; group < summands.groups; group += GROUP_THREADS) {
        let sums = partial_sums[group];
        own.a += sums.a;
        own.b += sums.b;
        own.c += sums.c;
        own.d += sums.d;
        own.largest = max(own.largest, sums.largest);
    }
    let all = group_sums(lane, own);
    if (lane == 0u) {
        totals[summands.place] = all;
    }
}
