// Thirty-two threads share the long list of a control: eight controls per workgroup. `list` has one row per control: its
// length, then its entries.

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
    // The next sum overwrites the memory of this one.
    workgroupBarrier();
    return sum;
}
