// GroupSums and largest values over the threads of a group, always in the same order.

var<workgroup> shared_rows: array<vec4<f32>, GROUP_THREADS>;

fn no_sums() -> GroupSums {
    let zero = vec4<f32>(0.0);
    return GroupSums(zero, zero, zero, zero, vec4<f32>(NO_VALUE));
}

// The same for all threads.
fn group_row(lane: u32, own: vec4<f32>, is_largest: bool) -> vec4<f32> {
    shared_rows[lane] = own;
    for (var half = GROUP / 2u; half > 0u; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            let a = shared_rows[lane];
            let b = shared_rows[lane + half];
            shared_rows[lane] = select(a + b, max(a, b), is_largest);
        }
    }
    workgroupBarrier();
    let all = shared_rows[0];
    workgroupBarrier();
    return all;
}

fn group_sums(lane: u32, own: GroupSums) -> GroupSums {
    return GroupSums(
        group_row(lane, own.a, false),
        group_row(lane, own.b, false),
        group_row(lane, own.c, false),
        group_row(lane, own.d, false),
        group_row(lane, own.largest, true),
    );
}
