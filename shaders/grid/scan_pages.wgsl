// #include grid, scan
// Prefix sums, last pass: the first row of every cell. Sets the counts to zero for the next step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read_write> counts: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> page_sums: array<u32>;
@group(0) @binding(4) var<storage, read_write> starts: array<vec4<u32>>;

fn total(values: vec4<u32>) -> u32 {
    return values.x + values.y + values.z + values.w;
}

fn exclusive(values: vec4<u32>, before: u32) -> vec4<u32> {
    let y = before + values.x;
    let z = y + values.y;
    return vec4<u32>(before, y, z, z + values.z);
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let page = group_of(group, groups);
    let pages = grid.cells / PAGE_CELLS + 1u;
    if (clock.running == 0u || page >= pages) {
        return;
    }
    var start = 0u;
    if (pages > ONE_GROUP_PAGES) {
        start = page_sums[page];
    } else {
        // Few pages: each adds up those before it.
        var of_page = 0u;
        if (lane < page) {
            of_page = page_sums[lane];
        }
        start = group_scan(lane, vec4<u32>(of_page, 0u, 0u, 0u)).all.x;
    }
    // Four tiles at once, four values a thread.
    let first = page * (PAGE_CELLS / 4u) + lane;
    let a = counts[first];
    let b = counts[first + GROUP_THREADS];
    let c = counts[first + 2u * GROUP_THREADS];
    let d = counts[first + 3u * GROUP_THREADS];
    let scan = group_scan(lane, vec4<u32>(total(a), total(b), total(c), total(d)));
    let before = exclusive(scan.all, start) + scan.before;
    starts[first] = exclusive(a, before.x);
    starts[first + GROUP_THREADS] = exclusive(b, before.y);
    starts[first + 2u * GROUP_THREADS] = exclusive(c, before.z);
    starts[first + 3u * GROUP_THREADS] = exclusive(d, before.w);
    counts[first] = vec4<u32>(0u);
    counts[first + GROUP_THREADS] = vec4<u32>(0u);
    counts[first + 2u * GROUP_THREADS] = vec4<u32>(0u);
    counts[first + 3u * GROUP_THREADS] = vec4<u32>(0u);
}
