// Light that leaves the floor, sponges and bodies.

// How a ray arrives at a solid.
struct Arrival {
    point: vec3<f32>,
    direction: vec3<f32>,
    // Whole way from the eye (m).
    way: f32,
    // Whether water thinner than a layer of particles is on the solid, and whether the ray comes through water.
    film: bool,
    wet: bool,
}

// Notes something that a path met: neighbours with other paths get more rays.
fn meet(met: u32, what: u32) -> u32 {
    let mixed = (met ^ what) * 0x9E3779B1u;
    return (mixed << 13u) | (mixed >> 19u);
}

// Light with the note of what it comes from.
struct Shine {
    light: vec3<f32>,
    met: u32,
}

// Light from a solid itself, and what it mirrors: a direction and the share of the light from there.
struct Surface {
    light: vec3<f32>,
    mirrored: vec3<f32>,
    share: f32,
}

// A matt colour in the light that arrives. `shadow` has the share of the key light, and its way in water (m).
fn matt(colour: vec3<f32>, normal: vec3<f32>, shadow: vec2<f32>) -> vec3<f32> {
    let key = ROOM_KEY * (max(dot(normal, scene.light), 0.0) * shadow.x) * left_after(shadow.y);
    return colour * (key + hemisphere(normal) * left_after(0.8 * shadow.y));
}

fn sponge_light(facet: Facet, arrival: Arrival, shadow: vec2<f32>) -> Surface {
    let width = arrival.way * scene.pixel;
    let film = max(facet_film(facet), select(0.0, 1.0, arrival.film));
    let skin = skin_of(facet, arrival.direction, width, film);
    let lit = shadow.x;
    // The material scatters, so that light reaches around it.
    let wrap = max((dot(skin.normal, scene.light) + 0.25) / 1.25, 0.0);
    let near_floor = 0.65 + 0.35 * smooth_between(0.0, 0.1 * scene.size, arrival.point.y - scene.ground_corner.y);
    let key = ROOM_KEY * (wrap * lit * (0.35 + 0.65 * skin.open)) * left_after(shadow.y);
    let around = hemisphere(skin.normal) * ((0.12 + 0.88 * skin.open) * near_floor);
    let half = unit_or(scene.light - arrival.direction, vec3(0.0));
    // A film in the open cells glints a little; it is too rough to mirror.
    let glint = 0.24 * lit * smooth_between(0.4, 0.9, skin.wet) * skin.open * pow(max(dot(skin.normal, half), 0.0), 28.0);
    let inner = skin.albedo * (key + around * left_after(0.8 * shadow.y));
    if (arrival.wet) {
        return Surface(inner, skin.outer, 0.0);
    }
    // A film over the cells is smooth, and fills pores in part.
    let sheet = unit_or(skin.outer + skin.normal * MATTER_FILM_RELIEF, skin.outer);
    let share = film * min(schlick(0.02, -dot(arrival.direction, sheet)), MATTER_FILM_MIRROR);
    let gleam = MATTER_FILM_GLEAM * film * lit * pow(max(dot(sheet, half), 0.0), 120.0);
    let light = inner * (1.0 - share) + ROOM_KEY * (glint + gleam);
    return Surface(light, reflect(arrival.direction, sheet), share * near_floor);
}

// How much a place of the ground looks as it does far away, 0 to 1.
fn fade(point: vec3<f32>) -> f32 {
    return smooth_between(1.1 * scene.size, 4.4 * scene.size, length(point - scene.centre));
}

// Paint with a clear coat.
fn painted(body: u32, normal: vec3<f32>, arrival: Arrival, shadow: vec2<f32>) -> Surface {
    let colour = body_row(body, 5u);
    let mirrored = reflect(arrival.direction, normal);
    let is_plane = body_kind(body) == SHAPE_PLANE;
    let own = select(colour.xyz, MATTER_FLOOR_COLOUR, is_plane && colour.w == 0.0);
    let diffuse = matt(own, normal, shadow);
    if (is_plane) {
        return Surface(mix(diffuse, ROOM_FAR, fade(arrival.point)), mirrored, 0.0);
    }
    let dim = select(0.9, 0.72, mirrored.y < 0.0);
    let share = schlick(0.04, -dot(arrival.direction, normal)) * select(1.0, 0.1, arrival.wet);
    return Surface(diffuse * (1.0 - share), mirrored, share * dim);
}

// From light to dark within a pixel.
fn firm(t: f32, width: f32) -> f32 {
    return smooth_between(0.0, width, min(t, 1.0 - t));
}

// Lightness of the tiles of the floor, 1 in the mean, where a pixel has a width (m).
fn tiles(point: vec3<f32>, width: f32) -> f32 {
    let pitch = scene.pitch;
    let clear = 1.0 - smooth_between(0.15, 0.6, width / pitch);
    if (clear <= 0.0) {
        return 1.0;
    }
    let cell = floor(point.xz / pitch);
    let place = point.xz / pitch - cell;
    let number = bitcast<vec2<u32>>(vec2<i32>(cell));
    let sign = select(-0.1, 0.1, ((number.x + number.y) & 1u) == 0u);
    let check = 1.0 + sign * firm(place.x, width / pitch) * firm(place.y, width / pitch);
    let shade = 0.97 + 0.06 * unit((number.x * 7919u) ^ (number.y * 104729u));
    let joint = min(place, 1.0 - place) * pitch;
    let half = 0.0175 * pitch;
    let blur = max(0.5 * width, 0.01 * pitch);
    let line = (1.0 - smooth_between(half, half + 2.0 * blur, min(joint.x, joint.y)))
        * min(0.0225 * pitch / (0.0125 * pitch + blur), 1.0);
    return 1.0 + (check * shade * (1.0 - 0.35 * line) - 1.0) * clear;
}

fn floor_light(arrival: Arrival) -> Surface {
    let direction = arrival.direction;
    let away = fade(arrival.point);
    let width = arrival.way * scene.pixel / max(-direction.y, 0.05);
    let albedo = MATTER_FLOOR_COLOUR * (1.0 + (tiles(arrival.point, width) - 1.0) * (1.0 - away));
    let arriving = arriving_at(arrival.point);
    let wetness = min(max(arriving.w, select(0.0, 1.0, arrival.wet)), 1.0);
    let light = albedo * (1.0 - MATTER_WET_FLOOR * wetness) * arriving.xyz;
    let gloss = select(0.0, schlick(0.02, -direction.y) * 0.5 * wetness, wetness > 0.02 && !arrival.wet);
    return Surface(mix(light, ROOM_FAR, away), reflect(direction, vec3(0.0, 1.0, 0.0)), gloss * (1.0 - away));
}

// Light from a solid along a ray.
fn shine(matter: Matter, arrival: Arrival, met: u32) -> Shine {
    var surface: Surface;
    var now = met;
    if (matter.kind == MATTER_FLOOR) {
        surface = floor_light(arrival);
        now = meet(met, 5u);
    } else {
        let shadow = shadow_at(arrival.point);
        if (matter.kind == MATTER_SPONGE) {
            let facet = facet_of(matter.number, matter.place.xy);
            now = meet(met, 6u);
            if (scene.is_map == 0u) {
                surface = sponge_light(facet, arrival, shadow);
            } else {
                let normal = facet_normal(facet);
                surface = Surface(matt(colour_map(facet_wetness(facet)), normal, shadow), normal, 0.0);
            }
        } else if (matter.kind == MATTER_BEAD) {
            let normal = matter.place;
            let gloss = schlick(0.03, -dot(arrival.direction, normal)) * 0.4;
            let light = matt(ball_colour(matter.number), normal, shadow) * (1.0 - gloss);
            surface = Surface(light, reflect(arrival.direction, normal), gloss);
            now = meet(met, 8u);
        } else {
            surface = painted(matter.number, matter.place, arrival, shadow);
            now = meet(met, 7u + matter.number);
        }
    }
    if (surface.share > 0.0) {
        surface.light += room_light(surface.mirrored) * surface.share;
    }
    return Shine(surface.light, now);
}
