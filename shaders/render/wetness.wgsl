// #include numbers, scene
// How wet the floor is below the lowest water, in fixed point.

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> free: array<f32>;
// Contact and wetness of every texel.
@group(0) @binding(3) var<storage, read_write> hollows: array<atomic<u32>>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = row_of(group, groups, lane);
    if (row >= scene.particles || free[row] <= 0.5) {
        return;
    }
    let place = positions[row].xyz;
    if (place.y - scene.ground_corner.y >= 1.3 * scene.spacing) {
        return;
    }
    let at = (place.xz - scene.ground_corner.xz) / scene.texel;
    let reach = 1.5 * scene.spacing / scene.texel;
    let side = f32(scene.texels);
    let first = vec2<u32>(clamp(at - reach, vec2(0.0), vec2(side)));
    let end = vec2<u32>(clamp(at + reach + 1.0, vec2(0.0), vec2(side)));
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            let away = vec2(f32(x), f32(y)) + 0.5 - at;
            let share = 1.0 - dot(away, away) / (reach * reach);
            if (share > 0.0) {
                atomicAdd(&hollows[2u * (y * scene.texels + x) + 1u], fixed(1.2 * share * share));
            }
        }
    }
}
