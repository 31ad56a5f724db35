// The way of a point through a step, stopped where it would lead into a body; `sweep.rs` has the rules.

const ADVANCES: u32 = 12u;
const NEARLY: f32 = 1.0e-3;

fn into_body(body: Body, point: vec3<f32>) -> vec3<f32> {
    let arm = point - body.position.xyz;
    return vec3<f32>(dot(body.x.xyz, arm), dot(body.y.xyz, arm), dot(body.z.xyz, arm));
}

// What has to be added to the place `end` of a point that begins the step at `start`.
fn swept(before: Body, after: Body, margin: f32, nearly: f32, start: vec3<f32>, end: vec3<f32>) -> vec3<f32> {
    let first = into_body(before, start);
    let last = into_body(after, end);
    let way = last - first;
    let length = sqrt(dot(way, way));
    var place = first;
    var time = 0.0;
    var surface = local_surface(before, place);
    surface.distance -= margin;
    for (var k = 0u; k < ADVANCES; k += 1u) {
        if (surface.distance <= nearly || time >= 1.0) {
            break;
        }
        time = select(1.0, min(time + surface.distance / length, 1.0), length > 0.0);
        place = first + way * time;
        surface = local_surface(before, place);
        surface.distance -= margin;
    }
    let beyond = min(max(surface.distance, 0.0) + dot(last - place, surface.normal), 0.0);
    let out = surface.normal * -beyond;
    return out.x * after.x.xyz + out.y * after.y.xyz + out.z * after.z.xyz;
}
