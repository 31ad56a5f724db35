// What a ray meets next.

struct Event {
    kind: u32,
    distance: f32,
    matter: Matter,
    // Whether the matter is below a film of water.
    film: bool,
    // A body that lets light through.
    body: u32,
    span: Span,
    // A surface of water. Its normal is against the ray; it may be at a wall of the container; it bends and mirrors light.
    normal: vec3<f32>,
    is_wall: bool,
    strength: f32,
}

// Outward normal of the wall of the container that a point is nearest to.
fn face_at(point: vec3<f32>) -> vec3<f32> {
    let a = abs(point - scene.low);
    let b = abs(point - scene.high);
    let nearest = least(min(a, b));
    for (var axis = 0u; axis < 3u; axis++) {
        var outward = vec3(0.0);
        outward[axis] = 1.0;
        if (a[axis] == nearest) {
            return -outward;
        }
        if (b[axis] == nearest) {
            return outward;
        }
    }
    return vec3(0.0, 1.0, 0.0);
}

// Where a ray passes the container.
fn passage_of(origin: vec3<f32>, direction: vec3<f32>) -> Passage {
    if (scene.has_container == 0u) {
        return Passage(0.0, FAR_AWAY, false);
    }
    return boxed(scene.low, scene.high, origin, direction);
}

// The next event of a ray that is nearer than a distance. A whole ray meets bodies that let light through and the surface of the water;
// another one solids alone.
fn next_event(origin: vec3<f32>, direction: vec3<f32>, limit: f32, is_whole: bool, wet: bool, passage: Passage) -> Event {
    var matter = Matter(MATTER_NOTHING, limit, 0u, vec3(0.0));
    if (scene.has_floor != 0u && direction.y < 0.0) {
        let distance = max((scene.ground_corner.y - origin.y) / direction.y, 0.0);
        if (distance < limit) {
            matter = Matter(MATTER_FLOOR, distance, 0u, vec3(0.0));
        }
    }
    var clear = no_span();
    clear.enter = FAR_AWAY;
    var clear_body = 0u;
    let bodies_met = select(scene.opaque_bodies, scene.seen_bodies, is_whole);
    for (var body = 0u; body < bodies_met; body++) {
        let span = body_span(body, origin, direction);
        if (!span.hits || span.enter <= SETTING_NEAR) {
            continue;
        }
        if (body >= scene.opaque_bodies) {
            if (span.enter < clear.enter) {
                clear = span;
                clear_body = body;
            }
        } else if (span.enter < matter.distance) {
            matter = Matter(MATTER_BODY, span.enter, body, span.normal);
        }
    }
    let hit = sponge_on(origin, direction, matter.distance);
    if (hit.hits) {
        matter = Matter(MATTER_SPONGE, hit.distance, hit.slot, vec3(hit.place, 0.0));
    }
    matter = ball_on(origin, direction, matter);
    var event = Event(EVENT_NOTHING, FAR_AWAY, matter, false, clear_body, clear, vec3(0.0), false, 1.0);
    if (matter.kind != MATTER_NOTHING) {
        event.kind = EVENT_MATTER;
        event.distance = matter.distance;
    }
    if (clear.hits && clear.enter < event.distance) {
        event.kind = EVENT_CLEAR;
        event.distance = clear.enter;
    }
    if (is_whole) {
        return water_on(origin, direction, wet, passage, event);
    }
    return event;
}
