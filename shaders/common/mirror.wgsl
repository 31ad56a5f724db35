// Images of points in bodies, as in `mirror.rs`. Needs `surface`.

// From the closest point of the core of a body to a point, in its own frame.
struct Closest {
    away: vec3<f32>,
    is_there: bool,
    // Across which the surface is curved, in `CURVED_ALONG`.
    axis: vec3<f32>,
    // 0: in no direction, 1: across an axis, 2: in all directions.
    curved: u32,
}

struct Mirrored {
    position: vec3<f32>,
    ratio: f32,
    along: vec3<f32>,
    is_there: bool,
    between: vec3<f32>,
}

fn flat(away: vec3<f32>) -> Closest {
    return Closest(away, true, vec3<f32>(0.0), 0u);
}

fn curved_along(away: vec3<f32>, axis: vec3<f32>) -> Closest {
    return Closest(away, true, axis, 1u);
}

fn curved_around(away: vec3<f32>) -> Closest {
    return Closest(away, true, vec3<f32>(0.0), 2u);
}

fn closest_of_cuboid(core: vec3<f32>, local: vec3<f32>) -> Closest {
    let away = local - clamp(local, -core, core);
    let beyond = away != vec3<f32>(0.0);
    let count = dot(vec3<u32>(beyond), vec3<u32>(1u));
    var found = curved_along(away, select(vec3<f32>(1.0), vec3<f32>(0.0), beyond));
    found.is_there = count > 0u;
    found.curved = max(count, 1u) - 1u;
    return found;
}

// Of a triangle [E05, 5.1.5].
fn closest_of_triangle(point: vec3<f32>, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>) -> Closest {
    let ab = b - a;
    let ac = c - a;
    let d1 = dot(ab, point - a);
    let d2 = dot(ac, point - a);
    if (d1 <= 0.0 && d2 <= 0.0) {
        return curved_around(point - a);
    }
    let d3 = dot(ab, point - b);
    let d4 = dot(ac, point - b);
    if (d3 >= 0.0 && d4 <= d3) {
        return curved_around(point - b);
    }
    let vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        return curved_along(point - (a + (d1 / (d1 - d3)) * ab), normalize(ab));
    }
    let d5 = dot(ab, point - c);
    let d6 = dot(ac, point - c);
    if (d6 >= 0.0 && d5 <= d6) {
        return curved_around(point - c);
    }
    let vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        return curved_along(point - (a + (d2 / (d2 - d6)) * ac), normalize(ac));
    }
    let va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        let part = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return curved_along(point - (b + part * (c - b)), normalize(c - b));
    }
    let scale = 1.0 / (va + vb + vc);
    return flat(point - (a + ab * (vb * scale) + ac * (vc * scale)));
}

fn closest_of_hull(body: Body, local: vec3<f32>, range: f32) -> Closest {
    let size = body.core.x;
    var best = flat(vec3<f32>(0.0));
    best.is_there = false;
    for (var face = 0u; face < body.planes; face += 1u) {
        let plane = planes[body.first_plane + face];
        if (dot(plane.xyz, local) > size * plane.w + range) {
            return best;
        }
    }
    var least = 0.0;
    for (var k = 0u; k < body.triangles; k += 1u) {
        let first = body.first_triangle + 3u * k;
        let a = planes[first].xyz * size;
        let b = planes[first + 1u].xyz * size;
        let c = planes[first + 2u].xyz * size;
        if (dot(cross(b - a, c - a), local - a) <= 0.0) {
            continue;
        }
        let found = closest_of_triangle(local, a, b, c);
        var square = dot(found.away, found.away);
        if (found.curved == 0u) {
            square *= 1.0 - TIE;
        }
        if (!best.is_there || square < least) {
            least = square;
            best = found;
        }
    }
    return best;
}

fn closest(body: Body, local: vec3<f32>, range: f32) -> Closest {
    switch (body.shape) {
        case SHAPE_KIND_PLANE: {
            return flat(vec3<f32>(0.0, max(local.y, 0.0), 0.0));
        }
        case SHAPE_KIND_SPHERE: {
            return curved_around(local);
        }
        case SHAPE_KIND_CAPSULE: {
            let nearest = clamp(local.y, -body.core.y, body.core.y);
            var found = curved_along(vec3<f32>(local.x, local.y - nearest, local.z), vec3<f32>(0.0, 1.0, 0.0));
            found.curved = select(2u, 1u, nearest == local.y);
            return found;
        }
        case SHAPE_KIND_CUBOID: {
            return closest_of_cuboid(body.core, local);
        }
        default: {
            return closest_of_hull(body, local, range);
        }
    }
}

fn place_in(body: Body, point: vec3<f32>) -> vec3<f32> {
    let arm = point - body.position;
    return vec3<f32>(dot(body.x, arm), dot(body.y, arm), dot(body.z, arm));
}

// Whether the surface of a part of a compound is covered by another one where it is closest to a point.
fn is_hidden(body: Body, index: u32, point: vec3<f32>, found: Closest, reach: f32) -> bool {
    let length = sqrt(dot(found.away, found.away));
    let own = length - piece_of(body, index).rounding;
    let away = found.away * (own / length);
    let foot = point - (away.x * body.x + away.y * body.y + away.z * body.z);
    for (var other = 0u; other < body.parts; other += 1u) {
        let piece = piece_of(body, other);
        if (other == index || hull_surface(piece, place_in(piece, foot)).distance >= COVER * reach) {
            continue;
        }
        let closest = closest_of_hull(piece, place_in(piece, point), piece.rounding + 2.0 * reach);
        let distance = sqrt(dot(closest.away, closest.away)) - piece.rounding;
        if (!closest.is_there || distance < own || (distance == own && other < index)) {
            return true;
        }
    }
    return false;
}

// The image of a point outside of a convex piece of a body, if it is nearer than `reach`.
fn image_in(body: Body, index: u32, point: vec3<f32>, reach: f32) -> Mirrored {
    var image = Mirrored(point, 1.0, vec3<f32>(1.0), false, vec3<f32>(0.0));
    let piece = piece_of(body, index);
    let local = place_in(piece, point);
    let radius = piece.rounding;
    let found = closest(piece, local, radius + reach);
    let length = sqrt(dot(found.away, found.away));
    let distance = length - radius;
    let is_near = found.is_there && distance > 0.0 && distance < reach && length > 0.0;
    let is_shallow = found.curved == 0u || distance < DEEPEST * radius;
    if (!(is_near && is_shallow)) {
        return image;
    }
    if (body.shape == SHAPE_KIND_COMPOUND && is_hidden(body, index, point, found, reach)) {
        return image;
    }
    let away = found.away / length;
    let normal = away.x * body.x + away.y * body.y + away.z * body.z;
    let axis = found.axis.x * body.x + found.axis.y * body.y + found.axis.z * body.z;
    let ratio = (radius - distance) / (radius + distance);
    // R = a + b n n^T + c t t^T.
    var a = 1.0;
    var b = -2.0;
    var c = 0.0;
    if (found.curved == 1u) {
        image.ratio = ratio;
        b = -1.0 / ratio - 1.0;
        c = 1.0 / ratio - 1.0;
    } else if (found.curved == 2u) {
        image.ratio = ratio * ratio;
        a = 1.0 / ratio;
        b = -1.0 / (ratio * ratio) - 1.0 / ratio;
    }
    image.position = point - (2.0 * distance) * normal;
    image.along = a + b * normal * normal + c * axis * axis;
    image.between = b * normal.yzx * normal.zxy + c * axis.yzx * axis.zxy;
    image.is_there = true;
    return image;
}
