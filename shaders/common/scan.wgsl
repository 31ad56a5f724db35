// Prefix sums over the threads of a workgroup, in its shared memory; `scan_subgroup.wgsl` has the same functions.

struct Scan {
    // Sum over the threads before this one.
    before: vec4<u32>,
    // Sum over all threads.
    all: vec4<u32>,
}

var<workgroup> scanned: array<vec4<u32>, GROUP_THREADS>;

fn group_scan(lane: u32, own: vec4<u32>) -> Scan {
    scanned[lane] = own;
    for (var step = 1u; step < GROUP_THREADS; step = step * 2u) {
        workgroupBarrier();
        var other = vec4<u32>(0u);
        if (lane >= step) {
            other = scanned[lane - step];
        }
        workgroupBarrier();
        scanned[lane] += other;
    }
    workgroupBarrier();
    let result = Scan(scanned[lane] - own, scanned[GROUP_THREADS - 1u]);
    workgroupBarrier();
    return result;
}
