// The material of sponges mirrored by walls, as in `solid_mirrors.rs`.

struct NodeImage {
    position: vec3<f32>,
    signs: vec3<f32>,
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

// The image of a node by one of the combinations of walls; 0 is the node itself.
fn mirrored(near: u32, index: u32, node: vec3<f32>) -> NodeImage {
    let by = vec3<u32>(index / 9u, index / 3u % 3u, index % 3u);
    var image = NodeImage(node, vec3<f32>(1.0), true);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        if (by[axis] > 0u) {
            let is_near = (near >> (2u * axis + by[axis] - 1u) & 1u) == 1u;
            let wall = select(params.wall_high[axis], params.wall_low[axis], by[axis] == 1u);
            image.position[axis] = 2.0 * wall - node[axis];
            image.signs[axis] = -1.0;
            image.is_there = image.is_there && is_near;
        }
    }
    return image;
}
