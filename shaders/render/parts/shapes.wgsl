// Intersection of rays with the shapes of bodies, and distances from them.

// Rows of four numbers: a record of `BODY_ROWS` for every body, then planes of hulls and parts of compounds.
@group(0) @binding(4) var<storage, read> bodies: array<vec4<f32>>;

// The part of a ray inside a shape.
struct Span {
    enter: f32,
    exit: f32,
    // Outward normal where it enters and where it leaves.
    normal: vec3<f32>,
    exit_normal: vec3<f32>,
    hits: bool,
}

fn no_span() -> Span {
    return Span(-FAR_AWAY, FAR_AWAY, vec3(0.0), vec3(0.0), false);
}

fn body_row(body: u32, row: u32) -> vec4<f32> {
    return bodies[body * BODY_ROWS + row];
}

fn body_kind(body: u32) -> u32 {
    return bitcast<u32>(body_row(body, 1u).w);
}

fn body_is_wire(body: u32) -> bool {
    return bitcast<u32>(body_row(body, 2u).w) != 0u;
}

fn body_rotation(body: u32) -> mat3x3<f32> {
    return mat3x3<f32>(body_row(body, 1u).xyz, body_row(body, 2u).xyz, body_row(body, 3u).xyz);
}

fn body_local(body: u32, point: vec3<f32>) -> vec3<f32> {
    return (point - body_row(body, 0u).xyz) * body_rotation(body);
}

// First row and number of the planes of a hull, or of the parts of a compound.
fn body_list(body: u32) -> vec2<u32> {
    return bitcast<vec2<u32>>(body_row(body, 7u).xy);
}

fn ball_span(o: vec3<f32>, d: vec3<f32>, radius: f32) -> Span {
    let a = dot(d, d);
    let b = -dot(o, d);
    // The cross product keeps digits that b * b - a * c would lose for a small ball far away.
    let across = cross(o, d);
    let discriminant = a * radius * radius - dot(across, across);
    if (discriminant <= 0.0) {
        return no_span();
    }
    let root = sqrt(discriminant);
    let enter = (b - root) / a;
    let exit = (b + root) / a;
    return Span(enter, exit, (o + d * enter) / radius, (o + d * exit) / radius, true);
}

// Clips a span at the half-space `normal . x <= offset`.
fn clipped(span: Span, normal: vec3<f32>, offset: f32, o: vec3<f32>, d: vec3<f32>) -> Span {
    var cut = span;
    let slope = dot(normal, d);
    let gap = offset - dot(normal, o);
    if (slope < 0.0) {
        let t = gap / slope;
        if (t > cut.enter) {
            cut.enter = t;
            cut.normal = normal;
        }
    } else if (slope > 0.0) {
        let t = gap / slope;
        if (t < cut.exit) {
            cut.exit = t;
            cut.exit_normal = normal;
        }
    } else if (gap < 0.0) {
        cut.hits = false;
    }
    cut.hits = cut.hits && cut.enter < cut.exit;
    return cut;
}

fn cuboid_span(o: vec3<f32>, d: vec3<f32>, half: vec3<f32>) -> Span {
    var span = no_span();
    span.hits = true;
    for (var axis = 0u; axis < 3u && span.hits; axis++) {
        var outward = vec3(0.0);
        outward[axis] = 1.0;
        span = clipped(span, outward, half[axis], o, d);
        span = clipped(span, -outward, half[axis], o, d);
    }
    return span;
}

fn hull_span(o: vec3<f32>, d: vec3<f32>, first: u32, count: u32) -> Span {
    var span = no_span();
    span.hits = true;
    for (var k = 0u; k < count && span.hits; k++) {
        let plane = bodies[first + k];
        span = clipped(span, plane.xyz, plane.w, o, d);
    }
    span.hits = span.hits && span.enter > -FAR_AWAY && span.exit < FAR_AWAY;
    return span;
}

// From where a ray first enters a part to where it leaves that and all that overlap it.
fn union_span(o: vec3<f32>, d: vec3<f32>, first: u32, count: u32) -> Span {
    var best = no_span();
    for (var round = 0u; round <= count; round++) {
        var changed = false;
        for (var k = 0u; k < count; k++) {
            let part = bodies[first + 2u * k];
            let list = bitcast<vec2<u32>>(bodies[first + 2u * k + 1u].xy);
            let span = hull_span(o - part.xyz, d, list.x, list.y);
            if (!span.hits || span.enter <= 0.0) {
                continue;
            }
            if (round == 0u) {
                if (!best.hits || span.enter < best.enter) {
                    best = span;
                    changed = true;
                }
            } else if (span.enter <= best.exit && span.exit > best.exit) {
                best.exit = span.exit;
                best.exit_normal = span.exit_normal;
                changed = true;
            }
        }
        if (!changed) {
            break;
        }
    }
    return best;
}

fn joined(a: Span, b: Span) -> Span {
    if (!a.hits) {
        return b;
    }
    if (!b.hits) {
        return a;
    }
    var all = a;
    if (b.enter < a.enter) {
        all.enter = b.enter;
        all.normal = b.normal;
    }
    if (b.exit > a.exit) {
        all.exit = b.exit;
        all.exit_normal = b.exit_normal;
    }
    return all;
}

fn capsule_span(o: vec3<f32>, d: vec3<f32>, half_height: f32, radius: f32) -> Span {
    let up = vec3(0.0, half_height, 0.0);
    var best = joined(ball_span(o - up, d, radius), ball_span(o + up, d, radius));
    let flat = vec3(1.0, 0.0, 1.0);
    if (d.x != 0.0 || d.z != 0.0) {
        var span = ball_span(o * flat, d * flat, radius);
        if (span.hits) {
            let begins = abs(o.y + d.y * span.enter) <= half_height;
            let ends = abs(o.y + d.y * span.exit) <= half_height;
            if (begins && !ends) {
                span.exit = span.enter;
                span.exit_normal = span.normal;
            } else if (ends && !begins) {
                span.enter = span.exit;
                span.normal = span.exit_normal;
            }
            if (begins || ends) {
                best = joined(best, span);
            }
        }
    }
    return best;
}

// The part of a ray inside a body, if the ray starts outside and hits; normals in world axes.
fn body_span(body: u32, origin: vec3<f32>, direction: vec3<f32>) -> Span {
    let rotation = body_rotation(body);
    let o = body_local(body, origin);
    let d = direction * rotation;
    let size = body_row(body, 4u);
    let list = body_list(body);
    var span = no_span();
    switch (body_kind(body)) {
        case SHAPE_PLANE: {
            // Visible from its outer side only: a wall between the eye and the scene would hide everything.
            if (o.y > 0.0 && d.y < 0.0) {
                span = Span(-o.y / d.y, FAR_AWAY, vec3(0.0, 1.0, 0.0), vec3(0.0, -1.0, 0.0), true);
            }
        }
        case SHAPE_SPHERE: { span = ball_span(o, d, size.x); }
        case SHAPE_CUBOID: { span = cuboid_span(o, d, size.xyz); }
        case SHAPE_CAPSULE: { span = capsule_span(o, d, size.y, size.x); }
        case SHAPE_HULL: { span = hull_span(o, d, list.x, list.y); }
        default: { span = union_span(o, d, list.x, list.y); }
    }
    span.hits = span.hits && span.enter > 0.0;
    span.normal = rotation * span.normal;
    span.exit_normal = rotation * span.exit_normal;
    return span;
}

fn hull_distance(p: vec3<f32>, first: u32, count: u32) -> f32 {
    var farthest = -FAR_AWAY;
    for (var k = 0u; k < count; k++) {
        let plane = bodies[first + k];
        farthest = max(farthest, dot(plane.xyz, p) - plane.w);
    }
    return farthest;
}

// Signed distance of a point from the surface of a body (m), negative inside.
fn body_distance(body: u32, point: vec3<f32>) -> f32 {
    let p = body_local(body, point);
    let size = body_row(body, 4u);
    let list = body_list(body);
    switch (body_kind(body)) {
        case SHAPE_PLANE: { return p.y; }
        case SHAPE_SPHERE: { return length(p) - size.x; }
        case SHAPE_CUBOID: {
            let q = abs(p) - size.xyz;
            return length(max(q, vec3(0.0))) + min(most(q), 0.0);
        }
        case SHAPE_CAPSULE: { return length(p - vec3(0.0, clamp(p.y, -size.y, size.y), 0.0)) - size.x; }
        case SHAPE_HULL: { return hull_distance(p, list.x, list.y); }
        default: {
            var nearest = FAR_AWAY;
            for (var k = 0u; k < list.y; k++) {
                let planes = bitcast<vec2<u32>>(bodies[list.x + 2u * k + 1u].xy);
                nearest = min(nearest, hull_distance(p - bodies[list.x + 2u * k].xyz, planes.x, planes.y));
            }
            return nearest;
        }
    }
}
