// Boundary volume fraction of walls and bodies around a point, as in `boundary.rs`: xyz its gradient, w the fraction.

// Volume fraction, and its slope into the surface, at a distance.
fn share_at(distance: f32) -> vec2<f32> {
    let depth = clamp(1.0 - distance / params.boundary_range, 0.0, MAXIMUM_DEPTH);
    let square = depth * depth;
    let fifth = square * square * depth;
    return vec2<f32>(fifth * depth, fifth * (6.0 / params.boundary_range)) * params.boundary_share;
}

fn wall_share(point: vec3<f32>) -> vec4<f32> {
    if (params.has_walls == 0u) {
        return vec4<f32>(0.0);
    }
    var gradient = vec3<f32>(0.0);
    var share = 0.0;
    for (var axis = 0u; axis < 3u; axis += 1u) {
        let below = share_at(point[axis] - params.wall_low[axis]);
        let above = share_at(params.wall_high[axis] - point[axis]);
        gradient[axis] = above.y - below.y;
        share += below.x + above.x;
    }
    return vec4<f32>(gradient, share);
}

fn body_share(body: Body, point: vec3<f32>) -> vec4<f32> {
    let surface = body_surface(body, point);
    let share = share_at(surface.distance);
    return vec4<f32>(surface.normal * -share.y, share.x);
}
