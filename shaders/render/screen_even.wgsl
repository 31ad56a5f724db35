// #include numbers, scene
// One pass of the narrow-range filter along rows or columns.

@group(0) @binding(1) var<storage, read> water: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read_write> after: array<vec4<f32>>;
// 0 along rows, 1 along columns.
@group(0) @binding(3) var<uniform> axis: vec4<u32>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = vec2(scene.screen_width, scene.screen_height);
    if (any(id.xy >= size)) {
        return;
    }
    let sample = id.y * size.x + id.x;
    let here = water[sample].x;
    if (!is_near(here)) {
        after[sample] = vec4(FAR_AWAY, 0.0, 0.0, 0.0);
        return;
    }
    let reach = clamp(SCREEN_REACH * scene.spacing * scene.screen_focal / here, 1.0, SCREEN_MOST_SAMPLES);
    let range = SCREEN_RANGE * scene.spacing;
    let behind = SCREEN_BEHIND * scene.spacing;
    let stride = select(1u, size.x, axis.x == 1u);
    let place = id[axis.x];
    // As far to one side as to the other, or a slope would shrink.
    let farthest = min(min(place, size[axis.x] - 1u - place), u32(ceil(reach)));
    var sums = vec2(here, water[sample].y);
    var total = 1.0;
    for (var tap = 1u; tap <= farthest; tap++) {
        let a = water[sample - tap * stride].xy;
        let b = water[sample + tap * stride].xy;
        let share = f32(tap) / (reach + 1.0);
        let weight = 1.0 - share * share;
        // In front of the range is another sheet; a pair keeps the filter even.
        if (a.x >= here - range && b.x >= here - range && weight > 0.0) {
            let first = select(a.x, here + behind, a.x > here + range);
            let second = select(b.x, here + behind, b.x > here + range);
            sums += weight * vec2(first + second, a.y + b.y);
            total += 2.0 * weight;
        }
    }
    after[sample] = vec4(sums / total, 0.0, 0.0);
}
