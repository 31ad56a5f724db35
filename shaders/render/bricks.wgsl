// #include numbers, scene
// Bricks of nodes that are all air, all water or neither.

@group(0) @binding(1) var<storage, read> densities: array<f32>;
@group(0) @binding(2) var<storage, read_write> bricks: array<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = row_of(group, groups, lane);
    let sides = scene.brick_sides;
    if (index >= sides.x * sides.y * sides.z) {
        return;
    }
    let brick = vec3(index % sides.x, (index / sides.x) % sides.y, index / (sides.x * sides.y));
    let first = brick * BRICKS_BRICK;
    let end = min(first + BRICKS_BRICK + 1u, scene.field_sides);
    var least_value = FAR_AWAY;
    var most_value = -FAR_AWAY;
    for (var z = first.z; z < end.z; z++) {
        for (var y = first.y; y < end.y; y++) {
            for (var x = first.x; x < end.x; x++) {
                let value = densities[(z * scene.field_sides.y + y) * scene.field_sides.x + x];
                least_value = min(least_value, value);
                most_value = max(most_value, value);
            }
        }
    }
    var content = BRICK_SURFACE;
    if (most_value < 0.0) {
        content = BRICK_AIR;
    } else if (least_value > 0.0) {
        content = BRICK_WATER;
    }
    bricks[index] = content | (BRICKS_LONGEST << 8u);
}
