// The surroundings: a room with windows, and the light that comes from them.

// Light that reaches a surface from above and below.
fn hemisphere(normal: vec3<f32>) -> vec3<f32> {
    return mix(vec3(0.40, 0.38, 0.36), vec3(0.62, 0.66, 0.72), 0.5 + 0.5 * normal.y);
}

fn pane(x: f32, pitch: f32, frame: f32) -> f32 {
    let cell = fract(x / pitch) - 0.5;
    return smooth_between(-0.03, 0.07, 0.5 * pitch - frame - abs(cell) * pitch);
}

// Light from a direction.
fn room_light(direction: vec3<f32>) -> vec3<f32> {
    if (direction.y < 0.0) {
        return mix(vec3(0.60, 0.59, 0.58), vec3(0.74, 0.75, 0.77), smooth_between(0.0, 0.35, -direction.y));
    }
    let place = direction * least(ROOM_HALF / max(abs(direction), vec3(1.0e-5)));
    if (place.y > ROOM_HALF.y - 0.01) {
        return vec3(0.74, 0.745, 0.75);
    }
    let wall = mix(vec3(0.42, 0.43, 0.45), vec3(0.62, 0.63, 0.66), place.y / ROOM_HALF.y);
    let sideways = abs(direction.x) > abs(direction.z);
    let along = select(place.x, place.z, sideways);
    if (sideways && direction.x >= 0.0) {
        return wall;
    }
    // Two rows of three panes.
    let inside = smooth_between(0.0, 0.15, 1.5 - abs(along)) * smooth_between(0.0, 0.35, place.y - 0.74)
        * smooth_between(0.0, 0.2, 1.86 - place.y);
    let glow = inside * pane(along + 0.48, 0.96, 0.04) * pane(place.y - 0.86, 0.48, 0.03);
    return wall * (1.0 - 0.5 * inside) + vec3(2.0, 2.2, 2.4) * (glow * (0.7 + 0.3 * place.y));
}

// Light of the background: the room, or the floor far away below the horizon.
fn background(direction: vec3<f32>) -> vec3<f32> {
    return mix(ROOM_FAR, room_light(direction), smooth_between(0.0, 0.3, direction.y));
}
