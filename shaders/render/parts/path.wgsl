// The path of a ray from the eye: reflections, refractions, absorption.

// A ray on its way.
struct Path {
    origin: vec3<f32>,
    direction: vec3<f32>,
    // Share of the light from here on that reaches the eye.
    through: vec3<f32>,
    // Light gathered so far.
    light: vec3<f32>,
    wet: bool,
    // Way from the eye (m).
    way: f32,
    met: u32,
}

// A number for each of the six directions of walls.
fn wall_code(normal: vec3<f32>) -> u32 {
    return u32(dot(normal, vec3(3.0, 5.0, 7.0)) + 120.5);
}

// Lines along the edges of the container.
fn edge_of(path: Path, point: vec3<f32>) -> Path {
    var after = path;
    if (scene.has_container == 0u) {
        return after;
    }
    let gap = min(abs(point - scene.low), abs(point - scene.high));
    // The smallest belongs to the wall of the point, the next one to the edge.
    let next = max(min(gap.x, gap.y), min(max(gap.x, gap.y), gap.z));
    let pixel = max(path.way * scene.pixel, 1.0e-5);
    let line = 0.0022 * scene.size;
    let cover = 0.5 * (1.0 - smooth_between(line, line + 1.2 * pixel, next));
    if (cover > 0.0) {
        after.met = meet(after.met, 0x55u);
        after.light += after.through * vec3(0.42, 0.50, 0.50) * cover;
        after.through *= 1.0 - cover;
    }
    return after;
}

// A pane of the container between air and air: a weak mirror, with the edges of the container.
fn pane_of(path: Path, distance: f32) -> Path {
    var after = path;
    let point = path.origin + path.direction * distance;
    let normal = face_at(point);
    after.met = meet(after.met, wall_code(normal));
    if (abs(scene.high.y - point.y) >= 1.0e-5) {
        let cosine = dot(path.direction, normal);
        let slant = (1.0 - abs(cosine)) * (1.0 - abs(cosine));
        let share = 0.035 * (0.5 + 4.0 * slant * slant);
        // The near pane mirrors the room, the far pane the inside of the container.
        var seen = vec3(0.55);
        if (cosine < 0.0) {
            seen = room_light(reflect(path.direction, normal));
        }
        after.light += after.through * seen * (share * 0.6);
        after.through *= 1.0 - share;
    }
    after.way += distance;
    after = edge_of(after, point);
    after.way = path.way;
    return after;
}

// The rays of a path. It goes on, looks along a mirrored ray, or looks for what is in a body that it passes. In the fast view it also looks
// for what ends the water, and for what is below that.
struct Ray {
    kind: u32,
    origin: vec3<f32>,
    direction: vec3<f32>,
    limit: f32,
    // Share of its light that reaches the eye, for a mirrored ray.
    weight: vec3<f32>,
    way: f32,
}

fn main_ray(path: Path) -> Ray {
    return Ray(RAY_MAIN, path.origin, path.direction, FAR_AWAY, vec3(1.0), path.way);
}

// The surface of the water: the mirrored ray is gathered, the refracted one goes on.
fn bend(path: ptr<function, Path>, event: Event, mirrors: bool) -> Ray {
    let normal = event.normal;
    let before = *path;
    let point = before.origin + before.direction * event.distance;
    (*path).way += event.distance;
    (*path).met = meet(before.met, 10u + select(0u, 2u, event.is_wall) + select(0u, 1u, before.wet));
    if (event.is_wall) {
        (*path).met = meet((*path).met, wall_code(normal));
        if (before.wet) {
            *path = edge_of(*path, point);
        }
    }
    let mirrored = reflect(before.direction, normal);
    let bent = refracted(before.direction, normal, select(1.0 / OPTICS_INDEX, OPTICS_INDEX, before.wet));
    if (!bent.passes) {
        (*path).met = meet((*path).met, 3u);
        (*path).direction = mirrored;
        (*path).origin = point + normal * scene.nudge;
        return main_ray(*path);
    }
    let share = bent.mirrored * event.strength;
    let weight = (*path).through * share;
    (*path).through *= 1.0 - share;
    (*path).direction = normalize(mix(before.direction, bent.direction, event.strength));
    (*path).origin = point - normal * scene.nudge;
    (*path).wet = !before.wet;
    if (before.wet) {
        (*path).light += weight * scene.scatter;
        return main_ray(*path);
    }
    // Of weak mirrors the room is seen alone.
    let limit = select(0.0, FAR_AWAY, bent.mirrored > 0.024 && mirrors);
    return Ray(RAY_MIRROR, point + normal * scene.nudge, mirrored, limit, weight, (*path).way);
}

// One shell of a body that lets light through.
fn shell_of(path: Path, body: u32, distance: f32, normal: vec3<f32>, weight: f32, pixel: f32) -> Path {
    var after = path;
    let wire = body_is_wire(body);
    let point = path.origin + path.direction * distance;
    let slant = 1.0 - clamp(-dot(path.direction, normal), 0.0, 1.0);
    let grazing = slant * slant * slant * slant;
    let share = weight * select(1.0, 0.8, path.wet) * select(0.045 + 0.9 * grazing, 0.0, wire);
    let line = 0.004 * max(min(body_row(body, 0u).w, 0.3 * scene.size), 0.05 * scene.size);
    var gap = body_edge(body, point);
    if (wire) {
        gap = body_wire(body, point);
    }
    let rim = (1.0 - smooth_between(line, line + 1.5 * pixel, gap)) * select(0.5, 0.9, wire);
    let ink = select(vec3(0.75, 0.82, 0.82), body_row(body, 5u).xyz, wire);
    let seen = room_light(reflect(path.direction, normal));
    after.light += after.through * (seen * share + ink * rim);
    after.through *= body_row(body, 6u).xyz * ((1.0 - share) * (1.0 - rim));
    return after;
}

// What a path gathers on its way to an event.
fn on_the_way(path: Path, event: Event, passage: Passage) -> Path {
    var after = path;
    if (path.wet) {
        let left = left_after(event.distance);
        after.light += path.through * scene.scatter * (1.0 - left) * PATH_SCATTERED;
        after.through *= left;
    } else if (passage.hits) {
        for (var side = 0u; side < 2u; side++) {
            let at = select(passage.enter, passage.leave, side == 1u);
            if (at > PATH_BEHIND && at < event.distance + SETTING_NEAR) {
                after = pane_of(after, at);
            }
        }
    }
    return after;
}

// How a ray arrives at a solid.
fn arrival_of(ray: Ray, path: Path, sheet: Sheet, event: Event) -> Arrival {
    let point = ray.origin + ray.direction * event.distance;
    let film = event.film || (ray.kind == RAY_BELOW && sheet.strength < 0.5 && event.matter.kind != MATTER_BODY);
    let wet = ray.kind == RAY_BELOW || (ray.kind != RAY_MIRROR && path.wet);
    return Arrival(point, ray.direction, ray.way + event.distance, film, wet);
}

// Light that comes to the eye from a place in pixels, and what its path met.
//
// Every ray is followed at one place of the text: what is inlined often takes long to compile.
fn radiance(x: f32, y: f32) -> Shine {
    let sight = direction_of(x, y);
    var sheet = sheet_on(x, y, sight);
    var path = Path(scene.eye, sight, vec3(1.0), vec3(0.0), is_wet(scene.eye), 0.0, 0u);
    var ray = main_ray(path);
    if (sheet.is_there) {
        ray.kind = RAY_SHEET;
        ray.limit = sheet.depth + sheet.thickness;
    }
    var span = no_span();
    var body = 0u;
    var events = 0u;
    for (var count = 0u; count < 3u * PATH_EVENTS; count++) {
        let is_main = ray.kind == RAY_MAIN;
        if (is_main && (events == PATH_EVENTS || most(path.through) < 0.01)) {
            break;
        }
        let passage = passage_of(ray.origin, ray.direction);
        let event = next_event(ray.origin, ray.direction, ray.limit, is_main, path.wet, passage);
        if (ray.kind == RAY_SHEET) {
            if (event.kind == EVENT_MATTER) {
                sheet.thickness = event.distance - sheet.depth;
            }
            ray = main_ray(path);
            if (sheet.thickness > 0.0) {
                path.met = meet(path.met, 10u);
                sheet = bend_sheet(sheet, sight);
                ray = Ray(RAY_BELOW, sheet.point + sight * 1.0e-5, sheet.below, FAR_AWAY, vec3(1.0), sheet.depth);
            }
            continue;
        }
        if (is_main) {
            events++;
            path = on_the_way(path, event, passage);
        }
        var seen = Shine(vec3(0.0), path.met);
        if (event.kind == EVENT_MATTER) {
            seen = shine(event.matter, arrival_of(ray, path, sheet, event), path.met);
        } else if (event.kind == EVENT_NOTHING && ray.kind != RAY_INSIDE) {
            let sky = select(ray.direction, sight, ray.kind == RAY_BELOW);
            seen.light = room_light(sky);
            if (ray.kind != RAY_MIRROR) {
                seen.light = mix(ROOM_FAR, seen.light, smooth_between(0.0, 0.3, sky.y));
            }
            seen.met = meet(path.met, 2u);
        }
        if (ray.kind == RAY_MIRROR) {
            path.light += ray.weight * seen.light;
            ray = main_ray(path);
            continue;
        }
        if (ray.kind == RAY_BELOW) {
            return Shine(through_sheet(sheet, sight, seen.light, event), seen.met);
        }
        if (event.kind == EVENT_MATTER || (is_main && event.kind == EVENT_NOTHING)) {
            return Shine(path.light + path.through * seen.light, meet(seen.met, select(0u, 1u, event.film)));
        }
        if (event.kind == EVENT_SURFACE) {
            ray = bend(&path, event, events < 4u);
            continue;
        }
        // A body that lets light through has two shells, without refraction: it shows what it squeezes.
        if (is_main) {
            span = event.span;
            body = event.body;
            path.met = meet(path.met, 40u + body);
        }
        if (is_main || is_near(span.exit)) {
            let at = select(span.exit, span.enter, is_main);
            let normal = select(-span.exit_normal, span.normal, is_main);
            path = shell_of(path, body, at, normal, select(0.45, 1.0, is_main), scene.pixel * (path.way + span.enter));
        }
        if (is_main) {
            let start = span.enter + PATH_BEHIND;
            let inside = path.origin + path.direction * start;
            ray = Ray(RAY_INSIDE, inside, path.direction, span.exit - span.enter, vec3(1.0), path.way + start);
            continue;
        }
        let exit = select(span.enter, span.exit, is_near(span.exit));
        path.way += exit;
        path.origin += path.direction * (exit + PATH_BEHIND);
        path.wet = is_wet(path.origin + path.direction * (20.0 * PATH_BEHIND));
        ray = main_ray(path);
    }
    return Shine(path.light + path.through * scene.scatter * 1.5, meet(path.met, 4u));
}
