// Thirty-two threads share the long list of a control: eight controls per workgroup. `list` has one row per control: its
// length, then its entries.

var<workgroup> parts: array<vec4<f32>, GROUP_THREADS>;

fn control_row(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return group_of(group, groups) * CONTROLS_PER_GROUP + lane / CONTROL_THREADS;
}

// Sum over the threads of a control, always in the same order.
fn control_sum(lane: u32, own: vec4<f32>) -> vec4<f32> {
    parts[lane] = own;
    for (var half = CONTROL_THREADS / 2u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane % CONTROL_THREADS < half) {
            parts[lane] += parts[lane + half];
        }
    }
    workgroupBarrier();
    let sum = parts[lane - lane % CONTROL_THREADS];
    // The next sum overwrites the memory of this one.
    workgroupBarrier();
    return sum;
}
