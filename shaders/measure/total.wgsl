// #include sums
// The sums of all workgroups of one of the other passes, in a fixed order.

struct Summands {
    groups: u32,
    // Index of the total.
    place: u32,
    unused_0: u32,
    unused_1: u32,
}

@group(0) @binding(0) var<uniform> summands: Summands;
@group(0) @binding(1) var<storage, read> partial_sums: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> totals: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(@builtin(local_invocation_index) lane: u32) {
    var own = no_sums();
    for (var group = lane; group < summands.groups; group += 256u) {
        let first = group * 5u;
        own.a += partial_sums[first];
        own.b += partial_sums[first + 1u];
        own.c += partial_sums[first + 2u];
        own.d += partial_sums[first + 3u];
        own.largest = max(own.largest, partial_sums[first + 4u]);
    }
    let all = group_sums(lane, own);
    if (lane == 0u) {
        let first = summands.place * 5u;
        totals[first] = all.a;
        totals[first + 1u] = all.b;
        totals[first + 2u] = all.c;
        totals[first + 3u] = all.d;
        totals[first + 4u] = all.largest;
    }
}
