// Sums of the numbers of the threads before, in a group.

var<workgroup> scanned: array<u32, PAGE_THREADS>;

// The sum of what the threads before a thread have.
fn sum_before(lane: u32, own: u32) -> u32 {
    scanned[lane] = own;
    for (var reach = 1u; reach < PAGE_THREADS; reach *= 2u) {
        workgroupBarrier();
        var before = 0u;
        if (lane >= reach) {
            before = scanned[lane - reach];
        }
        workgroupBarrier();
        scanned[lane] += before;
    }
    workgroupBarrier();
    return scanned[lane] - own;
}
