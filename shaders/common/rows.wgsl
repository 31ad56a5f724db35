// What all twins share: which row a thread has. Structs and constants are declared in Rust, see `layout.rs` of the kernels.

// Threads of a group, for passes whose threads have nothing to do with each other. With few rows, small groups keep more of the device
// busy.
override GROUP: u32 = GROUP_THREADS;

// The row of a thread; groups beyond the limit of one dimension continue in the second.
fn row_of(group: vec3<u32>, groups: vec3<u32>, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * GROUP + lane;
}

fn group_of(group: vec3<u32>, groups: vec3<u32>) -> u32 {
    return group.y * groups.x + group.x;
}

// The row with another vector in front of its scalar.
fn with_vector(row: vec4<f32>, vector: vec3<f32>) -> vec4<f32> {
    return vec4<f32>(vector, row.w);
}

// By its bits: compilers may assume that no number is infinite or not a number.
fn is_finite(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) != 0x7f800000u;
}
