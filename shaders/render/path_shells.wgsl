// #include numbers, colour, optics, room, scene, field, tree, shapes, foam, skin, ground, no_balls, setting
// #include events, matter, pixels
// The view of superimposed surfaces: sponges and water as shells that let light through, one over the other.

// A shell that a ray meets; `FAR_AWAY` after the last one.
struct Shell {
    distance: f32,
    normal: vec3<f32>,
    colour: vec3<f32>,
    cover: f32,
    code: u32,
}

// Where the search for the next shell of water goes on.
struct Search {
    start: f32,
    leave: f32,
    wet: bool,
    // The wall where the ray enters comes first, that where it leaves last.
    has_wall: bool,
    has_ended: bool,
}

fn water_shell(distance: f32, normal: vec3<f32>, code: u32) -> Shell {
    return Shell(distance, normal, SHELLS_WATER, SHELLS_WATER_COVER, code);
}

fn no_shell() -> Shell {
    return Shell(FAR_AWAY, vec3(0.0), vec3(0.0), 0.0, 0u);
}

fn begin_water(origin: vec3<f32>, direction: vec3<f32>) -> Search {
    if (scene.has_field == 0u) {
        return Search(0.0, FAR_AWAY, false, false, true);
    }
    if (scene.has_container == 0u) {
        return Search(0.0, FAR_AWAY, field_value(origin) > 0.0, false, false);
    }
    let passage = boxed(scene.low, scene.high, origin, direction);
    if (!passage.hits) {
        return Search(0.0, FAR_AWAY, false, false, true);
    }
    let start = max(passage.enter, 0.0);
    let wet = field_value(origin + direction * start) > 0.0;
    return Search(start, passage.leave, wet, wet && passage.enter > SETTING_NEAR, false);
}

fn next_water(origin: vec3<f32>, direction: vec3<f32>, search: ptr<function, Search>) -> Shell {
    if ((*search).has_ended) {
        return no_shell();
    }
    if ((*search).has_wall) {
        (*search).has_wall = false;
        return water_shell((*search).start, face_at(origin + direction * (*search).start), 12u);
    }
    let distance = march(origin, direction, vec2((*search).start, (*search).leave), (*search).wet);
    if (is_near(distance)) {
        let code = 10u + select(0u, 1u, (*search).wet);
        (*search).wet = !(*search).wet;
        (*search).start = distance + scene.nudge;
        return water_shell(distance, field_normal(origin + direction * distance), code);
    }
    (*search).has_ended = true;
    if ((*search).wet && is_near((*search).leave)) {
        return water_shell((*search).leave, face_at(origin + direction * (*search).leave), 13u);
    }
    return no_shell();
}

fn next_sponge(origin: vec3<f32>, direction: vec3<f32>, start: f32) -> Shell {
    let hit = tree_hit(origin + direction * start, direction, FAR_AWAY);
    if (!hit.hits) {
        return no_shell();
    }
    let facet = facet_of(hit.slot, hit.place);
    let colour = mix(SHELLS_SPONGE_DRY, SHELLS_SPONGE_SOAKED, smooth_between(0.03, 0.75, facet_wetness(facet)));
    return Shell(start + hit.distance, facet_normal(facet), colour, SHELLS_SPONGE_COVER, 6u);
}

// What the shells are in front of: bodies and the floor. Sponges are shells here.
fn behind_shells(origin: vec3<f32>, direction: vec3<f32>) -> Matter {
    let passage = Passage(0.0, FAR_AWAY, false);
    var start = 0.0;
    for (var count = 0u; count < SHELLS_SHELLS; count++) {
        var matter = next_event(origin + direction * start, direction, FAR_AWAY, false, false, passage).matter;
        start += matter.distance;
        if (matter.kind != MATTER_SPONGE) {
            matter.distance = start;
            return matter;
        }
        start += scene.nudge;
    }
    return Matter(MATTER_NOTHING, FAR_AWAY, 0u, vec3(0.0));
}

fn seen_at(x: f32, y: f32) -> Shine {
    let origin = scene.eye;
    let direction = direction_of(x, y);
    let end = behind_shells(origin, direction);
    var search = begin_water(origin, direction);
    var water = no_shell();
    var sponge = no_shell();
    var seeks_water = true;
    var seeks_sponge = true;
    var start = 0.0;
    var light = vec3(0.0);
    var through = 1.0;
    var met = 0u;
    // The next shells are sought at one place of the text: what is inlined often takes long to compile.
    for (var count = 0u; count < 2u * SHELLS_SHELLS; count++) {
        if (seeks_water) {
            water = next_water(origin, direction, &search);
        }
        if (seeks_sponge) {
            sponge = next_sponge(origin, direction, start);
        }
        seeks_water = water.distance <= sponge.distance;
        seeks_sponge = !seeks_water;
        var shell = sponge;
        if (seeks_water) {
            shell = water;
        }
        if (!is_near(shell.distance) || shell.distance >= end.distance - SHELLS_TOUCHING) {
            break;
        }
        start = shell.distance + scene.nudge;
        met = meet(met, shell.code);
        let normal = select(shell.normal, -shell.normal, dot(shell.normal, direction) > 0.0);
        let slant = 1.0 + dot(direction, normal);
        let cover = shell.cover + (0.9 - shell.cover) * smooth_between(0.3, 1.0, slant);
        let lit = ROOM_KEY * max(dot(normal, scene.light), 0.0) + hemisphere(normal);
        light += shell.colour * lit * (cover * through);
        through *= 1.0 - cover;
    }
    if (end.kind == MATTER_NOTHING) {
        return Shine(light + background(direction) * through, met);
    }
    let arrival = Arrival(origin + direction * end.distance, direction, end.distance, false, false);
    let behind = shine(end, arrival, met);
    return Shine(light + behind.light * through, behind.met);
}

fn water_on(origin: vec3<f32>, direction: vec3<f32>, wet: bool, passage: Passage, event: Event) -> Event {
    return event;
}
