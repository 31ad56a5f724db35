// Signed distance from a body (negative inside) and outward normal, at a point of the world, as in `body.rs`.

struct Surface {
    normal: vec3<f32>,
    distance: f32,
}

fn round_surface(local: vec3<f32>, radius: f32) -> Surface {
    let length = sqrt(dot(local, local));
    if (length > MINIMUM_RADIUS) {
        return Surface(local * (1.0 / length), length - radius);
    }
    return Surface(vec3<f32>(0.0, 1.0, 0.0), length - radius);
}

fn cuboid_surface(local: vec3<f32>, half: vec3<f32>) -> Surface {
    let sides = select(vec3<f32>(1.0), vec3<f32>(-1.0), local < vec3<f32>(0.0));
    let beyond = local * sides - half;
    let outside = max(beyond, vec3<f32>(0.0));
    let length = sqrt(dot(outside, outside));
    if (length > 0.0) {
        return Surface(sides * (outside * (1.0 / length)), length);
    }
    // Inside, the nearest face.
    if (beyond.x >= beyond.y && beyond.x >= beyond.z) {
        return Surface(vec3<f32>(sides.x, 0.0, 0.0), beyond.x);
    }
    if (beyond.y >= beyond.z) {
        return Surface(vec3<f32>(0.0, sides.y, 0.0), beyond.y);
    }
    return Surface(vec3<f32>(0.0, 0.0, sides.z), beyond.z);
}

fn hull_surface(body: Body, local: vec3<f32>) -> Surface {
    var nearest = Surface(vec3<f32>(0.0, 1.0, 0.0), -3.4e38);
    for (var face = 0u; face < body.planes; face += 1u) {
        let plane = planes[body.first_plane + face];
        let distance = dot(local, plane.xyz) - plane.w * body.size;
        if (distance > nearest.distance) {
            nearest = Surface(plane.xyz, distance);
        }
    }
    return nearest;
}

// A convex piece of a body: a part of a compound as a hull about its own centre, or the body itself. Velocities and torques are those of
// the body.
fn piece_of(body: Body, index: u32) -> Body {
    var piece = body;
    if (body.shape == SHAPE_KIND_COMPOUND) {
        let row = body.first_part + index * PART_ROWS;
        let centre = planes[row].xyz;
        let faces = planes[row + 1u];
        piece.shape = SHAPE_KIND_HULL;
        piece.position = body.position + (centre.x * body.x + centre.y * body.y + centre.z * body.z);
        piece.core = vec3<f32>(1.0);
        piece.rounding = faces.x;
        piece.first_plane = u32(faces.y);
        piece.planes = u32(faces.z);
        piece.first_triangle = u32(faces.w);
        piece.triangles = u32(planes[row + 2u].x);
    }
    return piece;
}

fn compound_surface(body: Body, local: vec3<f32>) -> Surface {
    var nearest = Surface(vec3<f32>(0.0, 1.0, 0.0), 3.4e38);
    for (var index = 0u; index < body.parts; index += 1u) {
        let centre = planes[body.first_part + index * PART_ROWS].xyz;
        let surface = hull_surface(piece_of(body, index), local - centre);
        if (surface.distance < nearest.distance) {
            nearest = surface;
        }
    }
    return nearest;
}

fn local_surface(body: Body, local: vec3<f32>) -> Surface {
    switch (body.shape) {
        case SHAPE_KIND_PLANE: {
            return Surface(vec3<f32>(0.0, 1.0, 0.0), local.y);
        }
        case SHAPE_KIND_SPHERE: {
            return round_surface(local, body.radius);
        }
        case SHAPE_KIND_CUBOID: {
            return cuboid_surface(local, body.extents);
        }
        case SHAPE_KIND_CAPSULE: {
            let on_axis = clamp(local.y, -body.extents.x, body.extents.x);
            return round_surface(vec3<f32>(local.x, local.y - on_axis, local.z), body.radius);
        }
        case SHAPE_KIND_HULL: {
            return hull_surface(body, local);
        }
        default: {
            return compound_surface(body, local);
        }
    }
}

fn body_surface(body: Body, point: vec3<f32>) -> Surface {
    let arm = point - body.position;
    let local = vec3<f32>(dot(body.x, arm), dot(body.y, arm), dot(body.z, arm));
    let surface = local_surface(body, local);
    let normal = surface.normal.x * body.x + surface.normal.y * body.y + surface.normal.z * body.z;
    return Surface(normal, surface.distance);
}

fn turned(turn: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v + 2.0 * cross(turn.xyz, cross(turn.xyz, v) + turn.w * v);
}

// The body at the end of the step.
fn at_end(body: Body) -> Body {
    var moved = body;
    moved.position = body.position + clock.step * body.linear;
    let turn = normalize(vec4<f32>(0.5 * clock.step * body.angular, 1.0));
    moved.x = turned(turn, body.x);
    moved.y = turned(turn, body.y);
    moved.z = turned(turn, body.z);
    return moved;
}
