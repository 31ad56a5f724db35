// #include numbers, scene
// How many bricks to each side of a brick, itself included, are as it is: the nearest other one along one axis after the other.

@group(0) @binding(1) var<storage, read> before: array<u32>;
@group(0) @binding(2) var<storage, read_write> bricks: array<u32>;
// 0, 1 or 2.
@group(0) @binding(3) var<uniform> axis: vec4<u32>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    let index = row_of(group, groups, lane);
    let sides = scene.brick_sides;
    if (index >= sides.x * sides.y * sides.z) {
        return;
    }
    let brick = vec3(index % sides.x, (index / sides.x) % sides.y, index / (sides.x * sides.y));
    let strides = vec3(1u, sides.x, sides.x * sides.y);
    let place = brick[axis.x];
    let side = sides[axis.x];
    let stride = strides[axis.x];
    let own = before[index] & 0xffu;
    var nearest = before[index] >> 8u;
    for (var apart = 1u; apart < BRICKS_LONGEST && apart < nearest; apart++) {
        if (place >= apart) {
            nearest = min(nearest, other(before[index - apart * stride], own, apart));
        }
        if (place + apart < side) {
            nearest = min(nearest, other(before[index + apart * stride], own, apart));
        }
    }
    if (own == BRICK_SURFACE) {
        nearest = 1u;
    }
    bricks[index] = own | (nearest << 8u);
}

// Distance to the nearest brick that differs from one, by way of a brick at a distance along the axis.
fn other(word: u32, own: u32, apart: u32) -> u32 {
    if ((word & 0xffu) != own) {
        return apart;
    }
    return max(word >> 8u, apart);
}
