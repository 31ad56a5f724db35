// #include numbers, scene
// How much ambient light nodes of sponges and bodies near the floor take away: round hills on the map, in fixed point. One group for
// every hill.

// Place and radius of a hill (m), and its height.
@group(0) @binding(1) var<storage, read> hills: array<vec4<f32>>;
// Contact and wetness of every texel.
@group(0) @binding(2) var<storage, read_write> hollows: array<atomic<u32>>;

@compute @workgroup_size(64)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = group.y * groups.x + group.x;
    if (row >= scene.hills) {
        return;
    }
    let hill = hills[row];
    let at = (hill.xy - scene.ground_corner.xz) / scene.texel;
    let reach = hill.z / scene.texel;
    let side = f32(scene.texels);
    let first = vec2<u32>(clamp(at - reach, vec2(0.0), vec2(side)));
    let end = vec2<u32>(clamp(at + reach + 1.0, vec2(0.0), vec2(side)));
    let size = max(end, first) - first;
    for (var k = lane; k < size.x * size.y; k += 64u) {
        let texel = first + vec2(k % size.x, k / size.x);
        let away = vec2<f32>(texel) + 0.5 - at;
        let share = 1.0 - dot(away, away) / (reach * reach);
        if (share > 0.0) {
            atomicAdd(&hollows[2u * (texel.y * scene.texels + texel.x)], fixed(hill.w * share * share));
        }
    }
}
