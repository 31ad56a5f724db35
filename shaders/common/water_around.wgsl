// How much of the space around a point a particle fills.

fn share_of(distance_squared: f32) -> f32 {
    let q = sqrt(distance_squared) / question.radius;
    if (q >= 1.0) {
        return 0.0;
    }
    let rest = (1.0 - q) * (1.0 - q);
    return question.scale * rest * rest * (4.0 * q + 1.0);
}

// A coordinate of an image of a particle: where it is (0), across or behind the low side (1) or the high side (2) of an axis. Beyond any
// reach where there is no such image: only particles within the radius of a side have one.
fn image_at(place: vec3<f32>, axis: u32, side: u32) -> f32 {
    let own = place[axis];
    if (side == 0u) {
        return own;
    }
    let is_low = side == 1u;
    if (params.has_periods == 1u && params.periods[axis] > 0.0) {
        let below = own - params.period_low[axis];
        let above = params.period_high[axis] - own;
        let moved = own + select(-params.periods[axis], params.periods[axis], is_low);
        return select(NO_IMAGE, moved, select(above, below, is_low) < question.radius);
    }
    if (params.has_walls == 1u) {
        let wall = select(params.wall_high[axis], params.wall_low[axis], is_low);
        let depth = select(wall - own, own - wall, is_low);
        return select(NO_IMAGE, 2.0 * wall - own, depth < question.radius);
    }
    return NO_IMAGE;
}

fn is_mirrored(axis: u32, side: u32) -> bool {
    return side > 0u && !(params.has_periods == 1u && params.periods[axis] > 0.0);
}

// Squares of the ways along an axis from a particle and its two images.
fn squares(point: vec3<f32>, place: vec3<f32>, axis: u32) -> vec3<f32> {
    let ways = point[axis] - vec3<f32>(image_at(place, axis, 0u), image_at(place, axis, 1u), image_at(place, axis, 2u));
    return ways * ways;
}

// Of the particle and its images across periodic sides (x), and of these and the images behind walls (y).
fn shares_around(point: vec3<f32>, place: vec3<f32>) -> vec2<f32> {
    let x = squares(point, place, 0u);
    let y = squares(point, place, 1u);
    let z = squares(point, place, 2u);
    let least = min(x.x, min(x.y, x.z)) + min(y.x, min(y.y, y.z)) + min(z.x, min(z.y, z.z));
    var shares = vec2<f32>(0.0);
    if (least >= question.radius * question.radius) {
        return shares;
    }
    for (var k = 0u; k < 27u; k += 1u) {
        let sides = vec3<u32>(k % 3u, k / 3u % 3u, k / 9u);
        let share = share_of(x[sides.x] + y[sides.y] + z[sides.z]);
        let behind = is_mirrored(0u, sides.x) || is_mirrored(1u, sides.y) || is_mirrored(2u, sides.z);
        shares += vec2<f32>(select(share, 0.0, behind), share);
    }
    return shares;
}
