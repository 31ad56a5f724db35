// The material of sponges mirrored by walls, as in `solid_mirrors.rs`.

struct Mirror {
    // Of the images: -1 times the coordinate and this, or the coordinate itself.
    signs: vec3<f32>,
    shift: vec3<f32>,
    is_there: bool,
}

// The walls within the radius of the lists: two bits an axis, the lower wall first.
fn walls_near(point: vec3<f32>) -> u32 {
    if (params.has_walls == 0u) {
        return 0u;
    }
    let low = abs(point - params.wall_low) < vec3<f32>(params.coupling.support_radius);
    let high = abs(point - params.wall_high) < vec3<f32>(params.coupling.support_radius);
    let lower = select(vec3<u32>(0u), vec3<u32>(1u, 4u, 16u), low);
    let upper = select(vec3<u32>(0u), vec3<u32>(2u, 8u, 32u), high);
    return lower.x | lower.y | lower.z | upper.x | upper.y | upper.z;
}

// One of the combinations of walls; 0 is none of them, whose image is the node itself.
fn mirror_of(near: u32, index: u32) -> Mirror {
    let by = vec3<u32>(index / 9u, index / 3u % 3u, index % 3u);
    var mirror = Mirror(vec3<f32>(1.0), vec3<f32>(0.0), true);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        if (by[axis] > 0u) {
            let wall = select(params.wall_high[axis], params.wall_low[axis], by[axis] == 1u);
            mirror.shift[axis] = 2.0 * wall;
            mirror.signs[axis] = -1.0;
            mirror.is_there = mirror.is_there && (near >> (2u * axis + by[axis] - 1u) & 1u) == 1u;
        }
    }
    return mirror;
}

// The image of a node.
fn mirrored(mirror: Mirror, node: vec3<f32>) -> vec3<f32> {
    return mirror.signs * node + mirror.shift;
}
