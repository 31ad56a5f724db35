// Part of the smoothing function of the cohesion in walls and bodies around a point: xyz the gradient of the logarithm of what they leave,
// w the part.

// That beyond a plane at a distance, and the slope of that logarithm into the plane.
fn cohesion_share_at(distance: f32) -> vec2<f32> {
    let depth = clamp(1.0 - distance * params.cohesion.inverse_radius, 0.0, 1.0);
    let square = depth * depth;
    let fifth = square * square * depth;
    let share = fifth * depth * (3.5 - depth * 4.5 + square * 1.5);
    let slope = fifth * (21.0 - depth * 31.5 + square * 12.0) * params.cohesion.inverse_radius;
    return vec2<f32>(share, slope / (1.0 - share));
}

fn cohesion_share_of_both(one: f32, other: f32) -> f32 {
    return one + other - one * other;
}

fn cohesion_share_of_walls(point: vec3<f32>) -> vec4<f32> {
    var share = vec4<f32>(0.0);
    if (params.has_walls != 0u) {
        for (var axis = 0u; axis < 3u; axis += 1u) {
            let below = cohesion_share_at(point[axis] - params.wall_low[axis]);
            let above = cohesion_share_at(params.wall_high[axis] - point[axis]);
            share[axis] = above.y - below.y;
            share.w = cohesion_share_of_both(cohesion_share_of_both(share.w, below.x), above.x);
        }
    }
    return share;
}

fn cohesion_share_of_body(body: Body, point: vec3<f32>) -> vec4<f32> {
    let surface = body_surface(body, point);
    let share = cohesion_share_at(surface.distance);
    return vec4<f32>(surface.normal * -share.y, share.x);
}
