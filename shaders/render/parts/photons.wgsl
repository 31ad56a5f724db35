// Light from the brightest window on its way to the floor: shadows, tinted by the water, and caustics. A photon is aimed at every
// texel, so that open floor is exactly as bright as without anything in the way.

// Ways along the light from the floor to the first solid and the first water (m), behind a map that another pass fills.
@group(0) @binding(5) var<storage, read_write> shadows: array<vec4<f32>>;
// Light of every texel: sums of red, green and blue in fixed point.
@group(0) @binding(7) var<storage, read_write> landed: array<atomic<u32>>;

fn land(place: vec3<f32>, share: vec3<f32>) {
    let at = (place.xz - scene.ground_corner.xz) / scene.texel - 0.5;
    let last = f32(scene.texels) - 1.0;
    if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < last && at.y < last)) {
        return;
    }
    let cell = vec2<u32>(at);
    let f = at - vec2<f32>(cell);
    for (var corner = 0u; corner < 4u; corner++) {
        let bits = vec2(corner & 1u, corner >> 1u);
        let weights = select(1.0 - f, f, bits != vec2(0u));
        let k = 3u * ((cell.y + bits.y) * scene.texels + cell.x + bits.x);
        let light = share * (weights.x * weights.y);
        atomicAdd(&landed[k], fixed(light.x));
        atomicAdd(&landed[k + 1u], fixed(light.y));
        atomicAdd(&landed[k + 2u], fixed(light.z));
    }
}

fn rise_of(point: vec3<f32>, towards: vec3<f32>) -> f32 {
    return (point.y - scene.ground_corner.y) / towards.y;
}

// Light that would meet the floor at a place without obstacles: the ways to the first solid and the first water.
fn photon(place: vec3<f32>, towards: vec3<f32>, reach: f32) -> vec2<f32> {
    var ways = vec2(-FAR_AWAY);
    var origin = place + towards * reach;
    var direction = -towards;
    var share = vec3(1.0);
    var wet = false;
    var straight = true;
    var inside = false;
    var span = no_span();
    var passed_body = 0u;
    var events = 0u;
    // Besides its own events the ray looks for what is in bodies that it passes, and, after it was bent, for what is in front.
    for (var count = 0u; count < 3u * PHOTONS_EVENTS && events < PHOTONS_EVENTS; count++) {
        let start = select(origin, origin + direction * (span.enter + 1.0e-5), inside);
        let limit = select(FAR_AWAY, span.exit - span.enter, inside);
        let event = next_event(start, direction, limit, !inside, wet, passage_of(origin, direction));
        let point = start + direction * event.distance;
        let is_floor = event.kind == EVENT_MATTER && event.matter.kind == MATTER_FLOOR;
        if (inside) {
            events++;
            if (event.kind == EVENT_MATTER && !is_floor) {
                if (straight) {
                    ways.x = rise_of(point, towards);
                }
                return ways;
            }
            if (!is_near(span.exit)) {
                return ways;
            }
            share *= body_row(passed_body, 6u).xyz * select(0.86, 1.0, body_is_wire(passed_body));
            origin += direction * (span.exit + 1.0e-5);
            wet = is_wet(origin + direction * 2.0e-4);
            inside = false;
            continue;
        }
        if (event.kind == EVENT_NOTHING) {
            return ways;
        }
        if (wet) {
            share *= left_after(event.distance);
        }
        if (event.kind == EVENT_CLEAR) {
            inside = true;
            span = event.span;
            passed_body = event.body;
            continue;
        }
        if (event.kind == EVENT_MATTER) {
            if (is_floor) {
                land(point, share);
            } else if (straight) {
                ways.x = rise_of(point, towards);
            } else {
                let hit = tree_hit(place + towards * reach, -towards, reach);
                if (hit.hits) {
                    ways.x = reach - hit.distance;
                }
            }
            return ways;
        }
        events++;
        if (straight && !wet) {
            ways.y = rise_of(point, towards);
        }
        straight = false;
        let bent = refracted(direction, event.normal, select(1.0 / OPTICS_INDEX, OPTICS_INDEX, wet));
        if (bent.passes) {
            share *= 1.0 - bent.mirrored * event.strength;
            direction = normalize(mix(direction, bent.direction, event.strength));
            origin = point - event.normal * scene.nudge;
            wet = !wet;
        } else {
            direction = reflect(direction, event.normal);
            origin = point + event.normal * scene.nudge;
        }
    }
    return ways;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let side = scene.texels;
    if (id.x >= side || id.y >= side) {
        return;
    }
    // Nine directions over the window, one for each texel of a block of 3 by 3.
    let offset = vec2<f32>(id.xy % 3u) - 1.0;
    let towards = normalize(scene.light + (scene.light_across * offset.x + scene.light_along * offset.y) * (0.8 * ROOM_LAMP));
    let place = scene.ground_corner + vec3(f32(id.x) + 0.5, 0.0, f32(id.y) + 0.5) * scene.texel;
    var ways = vec2(-FAR_AWAY);
    if (scene.lit_low.x > scene.lit_high.x || !boxed(scene.lit_low, scene.lit_high, place, towards).hits) {
        land(place, vec3(1.0));
    } else {
        ways = photon(place, towards, scene.light_reach * scene.light.y / towards.y);
    }
    shadows[side * side + id.y * side + id.x] = vec4(ways, 0.0, 0.0);
}
