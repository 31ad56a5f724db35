// Prefix sums over the threads of a workgroup, by subgroup operations: as `scan.wgsl`, for adapters that have them and whose
// subgroups are runs of threads.

struct Scan {
    // Sum over the threads before this one.
    before: vec4<u32>,
    // Sum over all threads.
    all: vec4<u32>,
}

// One for every subgroup.
var<workgroup> scanned: array<vec4<u32>, GROUP_THREADS>;

fn group_scan(lane: u32, own: vec4<u32>) -> Scan {
    let size = subgroupAdd(1u);
    let within = subgroupExclusiveAdd(own);
    let subgroup = lane / size;
    if (lane % size == size - 1u) {
        scanned[subgroup] = within + own;
    }
    workgroupBarrier();
    var result = Scan(within, vec4<u32>(0u));
    for (var other = 0u; other < GROUP_THREADS / size; other += 1u) {
        let part = scanned[other];
        result.all += part;
        if (other < subgroup) {
            result.before += part;
        }
    }
    workgroupBarrier();
    return result;
}
