// Several threads share the neighbours of a row where there are few rows. Each takes every SHARES-th one, and they add up in a fixed
// order. Neighbouring threads have neighbouring rows, which lists by column have side by side.

override SHARES: u32 = 1u;

var<workgroup> share_parts: array<vec4<f32>, GROUP_THREADS>;

struct SharedRow {
    row: u32,
    // Of the neighbours of the thread.
    first: u32,
    is_row: bool,
    // Whether the thread writes the results of the row.
    writes: bool,
    // Whether it is the last of the row, which knows the length of a list.
    is_last: bool,
}

// The row of a thread of `rows`. Threads without one repeat the last, since all threads of a group add up.
fn shared_row(group: vec3<u32>, groups: vec3<u32>, lane: u32, rows: u32) -> SharedRow {
    let wide = GROUP / SHARES;
    let row = group_of(group, groups) * wide + lane % wide;
    let first = lane / wide;
    let is_row = row < rows;
    return SharedRow(min(row, rows - 1u), first, is_row, is_row && first == 0u, is_row && first == SHARES - 1u);
}

// Whether no thread of a group has one of `rows`.
fn is_beyond(group: vec3<u32>, groups: vec3<u32>, rows: u32) -> bool {
    return group_of(group, groups) * (GROUP / SHARES) >= rows;
}

// Sum or largest values over the threads of a row, always in the same order. All threads of a group take part.
fn share_all(lane: u32, own: vec4<f32>, is_largest: bool) -> vec4<f32> {
    if (SHARES == 1u) {
        return own;
    }
    share_parts[lane] = own;
    for (var half = GROUP / 2u; half >= GROUP / SHARES; half = half / 2u) {
        workgroupBarrier();
        if (lane < half) {
            let a = share_parts[lane];
            let b = share_parts[lane + half];
            share_parts[lane] = select(a + b, max(a, b), is_largest);
        }
    }
    workgroupBarrier();
    let all = share_parts[lane % (GROUP / SHARES)];
    // The next ones overwrite the memory of these.
    workgroupBarrier();
    return all;
}

fn share_sum(lane: u32, own: vec4<f32>) -> vec4<f32> {
    return share_all(lane, own, false);
}

fn share_sum3(lane: u32, own: vec3<f32>) -> vec3<f32> {
    return share_sum(lane, vec4<f32>(own, 0.0)).xyz;
}

fn share_maximum(lane: u32, own: f32) -> f32 {
    return share_all(lane, vec4<f32>(own), true).x;
}

var<workgroup> share_counts: array<u32, GROUP_THREADS>;

// The sum over the threads of a row before this one; once in a pass.
fn share_before(lane: u32, own: u32) -> u32 {
    share_counts[lane] = own;
    workgroupBarrier();
    var sum = 0u;
    for (var other = lane % (GROUP / SHARES); other < lane; other += GROUP / SHARES) {
        sum += share_counts[other];
    }
    return sum;
}
