// The nearest solid on a ray.

// Something that ends a ray: its number, and the weights or the normal of the place.
struct Matter {
    kind: u32,
    distance: f32,
    number: u32,
    place: vec3<f32>,
}

// Where a ray enters and leaves a box, if it does so in front of its start.
struct Passage {
    enter: f32,
    leave: f32,
    hits: bool,
}

fn boxed(low: vec3<f32>, high: vec3<f32>, origin: vec3<f32>, direction: vec3<f32>) -> Passage {
    let inverse = inverse_of(direction);
    let a = (low - origin) * inverse;
    let b = (high - origin) * inverse;
    let enter = most(min(a, b));
    let leave = least(max(a, b));
    return Passage(enter, leave, enter < leave && leave > 0.0);
}

// The nearest place of a sponge on a ray that is nearer than a distance. A ray that grazes a pore may pass.
//
// The tree is searched at one place of the text: what is inlined often takes long to compile.
fn sponge_on(origin: vec3<f32>, direction: vec3<f32>, nearest: f32) -> Hit {
    var start = origin;
    var towards = direction;
    var limit = nearest;
    var passed = 0.0;
    var first = Hit(nearest, 0u, vec2(0.0), false);
    for (var search = 0u; search < 3u; search++) {
        var hit = tree_hit(start, towards, limit);
        if (search == 2u) {
            hit.distance += passed;
            return hit;
        }
        if (search == 0u) {
            first = hit;
            if (!hit.hits || scene.is_map != 0u) {
                return first;
            }
            if (-dot(direction, facet_normal(facet_of(hit.slot, hit.place))) > SETTING_GRAZING) {
                return first;
            }
            // Where it leaves the sponge, if that is near, is where a ray of the other direction would enter.
            start = origin + direction * (hit.distance + SETTING_NOTCH);
            towards = -direction;
            limit = SETTING_NOTCH;
            continue;
        }
        let exit = SETTING_NOTCH - hit.distance;
        if (!hit.hits || !is_notched(facet_of(first.slot, first.place), direction, exit)) {
            return first;
        }
        passed = first.distance + exit + 10.0 * SETTING_NEAR;
        start = origin + direction * passed;
        towards = direction;
        limit = nearest - passed;
    }
    return first;
}
