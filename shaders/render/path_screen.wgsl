// #include numbers, colour, optics, room, scene, tree, shapes, lines, foam, skin, ground, no_balls, setting
// #include events, no_water, matter, sheet, path, pixels
// The fast view: a ray that meets the water of the screen is bent once and ends at the solids behind it.

@group(0) @binding(1) var<storage, read> water: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> sheets: array<vec4<f32>>;

// The water at a place in pixels of the picture, between the four samples around it.
fn sheet_at(x: f32, y: f32) -> Sheet {
    let size = vec2(scene.screen_width, scene.screen_height);
    let place = clamp(vec2(x, y) / f32(SCREEN_COARSE) - 0.5, vec2(0.0), vec2<f32>(size) - 1.0);
    let first = vec2<u32>(place);
    let f = place - vec2<f32>(first);
    var nearest = FAR_AWAY;
    for (var corner = 0u; corner < 4u; corner++) {
        let at = min(first + vec2(corner & 1u, corner >> 1u), size - 1u);
        nearest = min(nearest, water[at.y * size.x + at.x].x);
    }
    var sums = vec2(0.0);
    var normal = vec3(0.0);
    var total = 0.0;
    for (var corner = 0u; corner < 4u; corner++) {
        let bits = vec2(corner & 1u, corner >> 1u);
        let at = min(first + bits, size - 1u);
        let weights = select(1.0 - f, f, bits != vec2(0u));
        let weight = weights.x * weights.y;
        let own = water[at.y * size.x + at.x].xy;
        // Of the nearest sheet alone.
        if (is_near(own.x) && own.x < nearest + scene.spacing) {
            sums += weight * own;
            normal += weight * sheets[at.y * size.x + at.x].xyz;
            total += weight;
        }
    }
    if (total < 0.5) {
        return no_sheet();
    }
    let turned = scene.right * normal.x + scene.up * normal.y + scene.forward * normal.z;
    var sheet = no_sheet();
    sheet.is_there = true;
    sheet.depth = sums.x / total;
    sheet.thickness = sums.y / total;
    sheet.normal = unit_or(turned, -scene.forward);
    return sheet;
}

// The same along the ray, and at the wall where water touches it.
fn sheet_on(x: f32, y: f32, direction: vec3<f32>) -> Sheet {
    var sheet = sheet_at(x, y);
    if (!sheet.is_there) {
        return sheet;
    }
    sheet.depth /= max(dot(direction, scene.forward), 1.0e-3);
    if (scene.has_container != 0u) {
        // The wall is the surface of water that touches it: balls there reach through it, or nearly so.
        let passage = boxed(scene.low, scene.high, scene.eye, direction);
        if (!passage.hits || sheet.depth > passage.leave) {
            sheet.is_there = false;
            return sheet;
        }
        if (sheet.depth < passage.enter + SCREEN_TOUCH * scene.spacing) {
            sheet.depth = passage.enter;
            sheet.normal = face_at(scene.eye + direction * passage.enter);
        }
    }
    return sheet;
}

// Refraction where it is known how thick the water is.
fn bend_sheet(sheet: Sheet, direction: vec3<f32>) -> Sheet {
    var bent_sheet = sheet;
    bent_sheet.point = scene.eye + direction * sheet.depth;
    let cosine = dot(sheet.normal, direction);
    let turned = normalize(sheet.normal - direction * (cosine + 0.05));
    bent_sheet.normal = select(turned, sheet.normal, cosine < -0.05);
    bent_sheet.strength = smooth_between(0.1, 0.8, sheet.thickness / scene.spacing);
    let bent = refracted(direction, bent_sheet.normal, 1.0 / OPTICS_INDEX);
    bent_sheet.mirrored = select(0.02, bent.mirrored, bent.passes);
    bent_sheet.below = normalize(mix(direction, bent.direction, bent_sheet.strength));
    return bent_sheet;
}

// Light from below the surface, and what that mirrors.
fn through_sheet(sheet: Sheet, direction: vec3<f32>, light: vec3<f32>, event: Event) -> vec3<f32> {
    let way = select(sheet.thickness, event.distance, event.kind == EVENT_MATTER);
    let left = left_after(min(sheet.thickness, way));
    let deep = light * left + scene.scatter * (1.0 - left) * 0.55;
    let share = sheet.mirrored * sheet.strength;
    return deep * (1.0 - share) + room_light(reflect(direction, sheet.normal)) * share;
}

fn seen_at(x: f32, y: f32) -> Shine {
    return radiance(x, y);
}
