// Thirty-two threads share the list of a control, which is long: eight controls a group. `list` has one row a control:
// its length, then its entries.

var<workgroup> parts: array<vec4<f32>, 256>;

fn control_row(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return group_of(group, groups) * 8u + lane / 32u;
}

// Sum over the threads of a control, always in the same order.
fn control_sum(lane: u32, own: vec4<f32>) -> vec4<f32> {
    parts[lane] = own;
    for (var half = 16u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if ((lane & 31u) < half) {
            parts[lane] += parts[lane + half];
        }
    }
    workgroupBarrier();
    let sum = parts[lane & 224u];
    // The next sum begins where this one was read.
    workgroupBarrier();
    return sum;
}
