// What the surface of the water does on a ray.

fn face_free(event: Event, distance: f32, normal: vec3<f32>, direction: vec3<f32>, strength: f32) -> Event {
    let cosine = dot(normal, direction);
    let turned = unit_or(normal - direction * (cosine + 0.02), -direction);
    var surface = event;
    surface.kind = EVENT_SURFACE;
    surface.distance = distance;
    surface.normal = select(turned, normal, cosine < -0.02);
    surface.is_wall = false;
    surface.strength = strength;
    return surface;
}

fn face_wall(event: Event, distance: f32, outward: vec3<f32>) -> Event {
    var surface = event;
    surface.kind = EVENT_SURFACE;
    surface.distance = distance;
    surface.normal = outward;
    surface.is_wall = true;
    surface.strength = 1.0;
    return surface;
}

// Whether a point is in the water.
fn is_wet(point: vec3<f32>) -> bool {
    if (scene.has_field == 0u) {
        return false;
    }
    if (scene.has_container != 0u && !(all(point > scene.low) && all(point < scene.high))) {
        return false;
    }
    return field_value(point) > 0.0;
}

// How much a surface in front of a solid bends and mirrors light; nothing where the water is a film.
fn strength_before(event: Event, distance: f32) -> f32 {
    if (event.kind != EVENT_MATTER) {
        return 1.0;
    }
    let layers = (event.distance - distance) / scene.spacing;
    if (event.matter.kind == MATTER_SPONGE) {
        return smooth_between(SETTING_FILM_ON_SPONGE.x, SETTING_FILM_ON_SPONGE.y, layers);
    }
    if (event.matter.kind == MATTER_FLOOR) {
        return smooth_between(SETTING_FILM_ON_FLOOR.x, SETTING_FILM_ON_FLOOR.y, layers);
    }
    return 1.0;
}

// The surface of the water on a ray if it is in front of another event, else that. A ray in water leaves it, one in air enters it.
fn water_on(origin: vec3<f32>, direction: vec3<f32>, wet: bool, passage: Passage, event: Event) -> Event {
    if (scene.has_field == 0u || (scene.has_container != 0u && !passage.hits)) {
        return event;
    }
    let is_boxed = scene.has_container != 0u;
    let enter = select(0.0, passage.enter, is_boxed);
    let leave = select(FAR_AWAY, passage.leave, is_boxed);
    let end = min(leave, event.distance);
    let start = select(max(enter, 0.0), 0.0, wet);
    if (!wet && start >= end) {
        return event;
    }
    if (!wet && enter > SETTING_NEAR) {
        let point = origin + direction * enter;
        if (field_value(point) > 0.0) {
            return face_wall(event, enter, face_at(point));
        }
    }
    let distance = march(origin, direction, vec2(start, end), wet);
    if (!is_near(distance)) {
        if (wet && is_near(leave) && leave < event.distance - 1.0e-5) {
            return face_wall(event, leave, -face_at(origin + direction * leave));
        }
        return event;
    }
    // Particles keep away from solids: what is between them and the solid is no air.
    if (wet && event.distance - distance < SETTING_GAP * scene.spacing) {
        return event;
    }
    let strength = select(strength_before(event, distance), 1.0, wet);
    if (strength <= 0.0) {
        var film = event;
        film.film = true;
        return film;
    }
    let outward = field_normal(origin + direction * distance);
    return face_free(event, distance, select(outward, -outward, wet), direction, strength);
}
