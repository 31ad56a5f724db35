// #include numbers, scene
// Points of every page of cells.

@group(0) @binding(1) var<storage, read> counts: array<u32>;
@group(0) @binding(2) var<storage, read_write> page_sums: array<u32>;

var<workgroup> sum: atomic<u32>;

@compute @workgroup_size(PAGE_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    if (lane == 0u) {
        atomicStore(&sum, 0u);
    }
    workgroupBarrier();
    let page = group.y * groups.x + group.x;
    var own = 0u;
    for (var k = 0u; k < PAGE_SHARE; k++) {
        let cell = (page * PAGE_THREADS + lane) * PAGE_SHARE + k;
        if (cell < scene.cell_count) {
            own += counts[cell];
        }
    }
    atomicAdd(&sum, own);
    workgroupBarrier();
    if (lane == 0u && page < scene.cell_pages) {
        page_sums[page] = atomicLoad(&sum);
    }
}
