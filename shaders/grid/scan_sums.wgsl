// Prefix sums, second pass: one group replaces the sums of the pages by the sums of all pages before them.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> grid: Grid;
@group(0) @binding(2) var<storage, read_write> page_sums: array<u32>;

var<workgroup> sums: array<u32, 256>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) lane: u32) {
    if (clock.running == 0u) {
        return;
    }
    let pages = grid.size.w / 4096u + 1u;
    var before = 0u;
    for (var first = 0u; first < pages; first += 1024u) {
        // Four consecutive pages a thread.
        let own = first + lane * 4u;
        var values = vec4<u32>(0u);
        for (var k = 0u; k < 4u; k += 1u) {
            if (own + k < pages) {
                values[k] = page_sums[own + k];
            }
        }
        sums[lane] = values.x + values.y + values.z + values.w;
        for (var step = 1u; step < 256u; step = step * 2u) {
            workgroupBarrier();
            var other = 0u;
            if (lane >= step) {
                other = sums[lane - step];
            }
            workgroupBarrier();
            sums[lane] += other;
        }
        workgroupBarrier();
        var sum = before;
        if (lane > 0u) {
            sum += sums[lane - 1u];
        }
        before += sums[255];
        workgroupBarrier();
        for (var k = 0u; k < 4u; k += 1u) {
            if (own + k < pages) {
                page_sums[own + k] = sum;
            }
            sum += values[k];
        }
    }
}
