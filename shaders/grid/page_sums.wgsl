// Prefix sums, first pass: the sum of every page of 4096 values (four pages of 32 x 32).

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read> counts: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read_write> page_sums: array<u32>;

var<workgroup> sums: array<u32, 256>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let page = group_of(group, groups);
    let pages = grid.size.w / 4096u + 1u;
    if (clock.running == 0u || page >= pages) {
        return;
    }
    // The buffer is padded with zeros to whole pages.
    let first = page * 1024u + lane;
    let all = counts[first] + counts[first + 256u] + counts[first + 512u] + counts[first + 768u];
    sums[lane] = all.x + all.y + all.z + all.w;
    for (var half = 128u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            sums[lane] += sums[lane + half];
        }
    }
    if (lane == 0u) {
        page_sums[page] = sums[0];
    }
}
