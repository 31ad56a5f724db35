@group(0) @binding(0) var<storage, read_write> found: array<u32>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(local_invocation_index) lane: u32) {
    found[lane] = group_scan(lane, vec4<u32>(lane, 1u, 0u, 0u)).before.x;
}
