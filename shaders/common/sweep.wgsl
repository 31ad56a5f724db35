// Path of a point through a step, and its first intersection with a body; `sweep.rs` has the rules.

const ADVANCES: u32 = 12u;
const NEARLY: f32 = 1.0e-3;
// Clearance of nodes from bodies, in edges.
const CLEARANCE: f32 = 1.0e-3;

// Intersection of a path with a body: the distance there, and that of the end of the path from the plane less it.
struct Met {
    distance: f32,
    beyond: f32,
    normal: vec3<f32>,
}

fn into_body(body: Body, point: vec3<f32>) -> vec3<f32> {
    let arm = point - body.position.xyz;
    return vec3<f32>(dot(body.x.xyz, arm), dot(body.y.xyz, arm), dot(body.z.xyz, arm));
}

fn out_of_body(body: Body, direction: vec3<f32>) -> vec3<f32> {
    return direction.x * body.x.xyz + direction.y * body.y.xyz + direction.z * body.z.xyz;
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
        if (surface.distance <= NEARLY * length || surface.distance >= left) {
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
