// Fourth pass of `tets::corners`: where the list of every control begins. Counts become the places of the next entries.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read_write> corner_counts: array<u32>;
@group(0) @binding(3) var<storage, read_write> control_corners: array<u32>;

var<workgroup> before: array<u32, GROUP_THREADS>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.node_rows;
    let wide = (rows + GROUP_THREADS - 1u) / GROUP_THREADS;
    let first = min(lane * wide, rows);
    let end = min(first + wide, rows);
    var own = 0u;
    for (var row = first; row < end; row += 1u) {
        own += corner_counts[row];
    }
    before[lane] = own;
    workgroupBarrier();
    var start = 0u;
    for (var other = 0u; other < lane; other += 1u) {
        start += before[other];
    }
    for (var row = first; row < end; row += 1u) {
        let count = corner_counts[row];
        control_corners[row] = start;
        corner_counts[row] = start;
        start += count;
    }
    if (lane == GROUP_THREADS - 1u) {
        control_corners[rows] = start;
    }
}
