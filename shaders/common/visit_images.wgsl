// All images of a particle, in the order of `image_rows.rs`. Needs `mirror`. The pass says what it takes of them:
// `take_image(k, position, base, body, walls)` of the k-th.

// A coordinate (0), its mirror image in the lower wall (1) and in the upper one (2).
fn place_of(value: f32, axis: u32, place: u32) -> f32 {
    let wall = select(params.wall_high[axis], params.wall_low[axis], place == 1u);
    return select(2.0 * wall - value, value, place == 0u);
}

fn has_place(value: f32, axis: u32, place: u32) -> bool {
    let wall = select(params.wall_high[axis], params.wall_low[axis], place == 1u);
    return place == 0u || params.has_walls != 0u && abs(value - wall) < params.smoothing.support_radius;
}

// All combinations of the walls along the axes; without any, a particle is no image of itself.
fn in_walls(base: Mirrored, body: u32, before: u32) -> u32 {
    let x = base.position;
    var count = before;
    for (var index = select(0u, 1u, body == NO_BODY); index < 27u; index += 1u) {
        let i = index / 9u;
        let j = index / 3u % 3u;
        let k = index % 3u;
        if (has_place(x.x, 0u, i) && has_place(x.y, 1u, j) && has_place(x.z, 2u, k)) {
            let position = vec3<f32>(place_of(x.x, 0u, i), place_of(x.y, 1u, j), place_of(x.z, 2u, k));
            let walls = select(0u, 1u, i > 0u) | select(0u, 2u, j > 0u) | select(0u, 4u, k > 0u);
            take_image(count, position, base, body, walls);
            count += 1u;
        }
    }
    return count;
}

// Their number.
fn visit_images(point: vec3<f32>) -> u32 {
    let near = min(point - params.wall_low, params.wall_high - point) < vec3<f32>(params.smoothing.support_radius);
    var count = 0u;
    if (params.has_walls != 0u && any(near)) {
        count = in_walls(Mirrored(point, 1.0, vec3<f32>(1.0), false, vec3<f32>(0.0)), NO_BODY, count);
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        for (var piece = 0u; piece < body_states[index].parts; piece += 1u) {
            let base = image_in(body_states[index], piece, point, BODY_REACH * params.spacing);
            let is_inside = all(base.position > params.wall_low) && all(base.position < params.wall_high);
            if (base.is_there && (params.has_walls == 0u || is_inside)) {
                count = in_walls(base, index, count);
            }
        }
    }
    return count;
}
