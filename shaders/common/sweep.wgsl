// Path of a point through a step, and its first intersection with a body; `sweep.rs` has the rules.

// Where a way meets a body: the distance there, and that of the end of the way from the plane less it.
struct Met {
    distance: f32,
    beyond: f32,
    normal: vec3<f32>,
}

fn into_body(body: Body, point: vec3<f32>) -> vec3<f32> {
    let arm = point - body.position;
    return vec3<f32>(dot(body.x, arm), dot(body.y, arm), dot(body.z, arm));
}

fn out_of_body(body: Body, direction: vec3<f32>) -> vec3<f32> {
    return direction.x * body.x + direction.y * body.y + direction.z * body.z;
}

// Follows a path in the frame of the body.
fn way_meets(body: Body, margin: f32, start: vec3<f32>, end: vec3<f32>) -> Met {
    let way = end - start;
    let length = sqrt(dot(way, way));
    var place = start;
    var left = length;
    var surface = local_surface(body, place);
    surface.distance -= margin;
    for (var k = 0u; k < ADVANCES; k += 1u) {
        if (surface.distance <= SWEEP_TOLERANCE * length || surface.distance >= left) {
            break;
        }
        place += way * (surface.distance / length);
        left -= surface.distance;
        surface = local_surface(body, place);
        surface.distance -= margin;
    }
    return Met(surface.distance, dot(end - place, surface.normal), surface.normal);
}

// Correction of the position `end` of a point that begins the step at `start`.
fn swept(before: Body, after: Body, margin: f32, start: vec3<f32>, end: vec3<f32>) -> vec3<f32> {
    let surface = way_meets(before, margin, into_body(before, start), into_body(after, end));
    let beyond = min(max(surface.distance, 0.0) + surface.beyond, 0.0);
    return out_of_body(after, surface.normal * -beyond);
}
