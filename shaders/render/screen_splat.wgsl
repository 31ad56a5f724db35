// #include numbers, scene, raster
// Particles as balls on the screen: their depth, and their thickness in fixed point.

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> free: array<f32>;
// The nearest depth, as bits that shrink as it grows; 0 without water.
@group(0) @binding(3) var<storage, read_write> depths: array<atomic<u32>>;
@group(0) @binding(4) var<storage, read_write> thicknesses: array<atomic<u32>>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let row = row_of(group, groups, lane);
    if (row >= scene.particles || free[row] <= 0.5) {
        return;
    }
    let radius = SCREEN_BALL * scene.spacing;
    let c = local_of(positions[row].xyz);
    if (c.z <= radius + scene.nearest) {
        return;
    }
    let scale = scene.screen_focal / c.z;
    let size = vec2(f32(scene.screen_width), f32(scene.screen_height));
    let middle = 0.5 * size + vec2(c.x, -c.y) * scale;
    let reach = radius * scene.screen_focal / (c.z - radius);
    let first = vec2<u32>(clamp(middle - reach, vec2(0.0), size));
    let end = vec2<u32>(clamp(middle + reach + 1.0, vec2(0.0), size));
    for (var y = first.y; y < end.y; y++) {
        for (var x = first.x; x < end.x; x++) {
            let slope = slopes_of(f32(x), f32(y));
            let across = vec3(slope.x * c.z - c.x, slope.y * c.z - c.y, slope.x * c.y - slope.y * c.x);
            let a = 1.0 + dot(slope, slope);
            let square = a * radius * radius - dot(across, across);
            if (square > 0.0) {
                let root = sqrt(square);
                let near = (slope.x * c.x + slope.y * c.y + c.z - root) / a;
                let sample = y * scene.screen_width + x;
                atomicMax(&depths[sample], ~bitcast<u32>(near));
                atomicAdd(&thicknesses[sample], fixed(2.0 * SCREEN_FILLING * root / sqrt(a)));
            }
        }
    }
}
