// A tree of boxes over the triangles of the sponges.

// Nodes of the tree, eight rows each; triangles, a corner with the number of its node in each of three rows; nodes of the sponges,
// three rows each: place and wetness, normal and film, place at rest.
@group(0) @binding(3) var<storage, read> mesh: array<vec4<f32>>;

// Where a ray meets a triangle: at the weights of its second and third corner.
struct Hit {
    distance: f32,
    slot: u32,
    place: vec2<f32>,
    hits: bool,
}

fn inverse_of(direction: vec3<f32>) -> vec3<f32> {
    let small = abs(direction) < vec3(1.0e-12);
    let least_slope = select(vec3(-1.0e-12), vec3(1.0e-12), direction >= vec3(0.0));
    return 1.0 / select(direction, least_slope, small);
}

fn triangle_hit(slot: u32, origin: vec3<f32>, direction: vec3<f32>, nearest: f32) -> Hit {
    let none = Hit(nearest, 0u, vec2(0.0), false);
    let at = scene.triangles_at + 3u * slot;
    let a = mesh[at].xyz;
    let e = mesh[at + 1u].xyz - a;
    let f = mesh[at + 2u].xyz - a;
    let p = cross(direction, f);
    let determinant = dot(e, p);
    if (determinant <= 1.0e-14) {
        return none;
    }
    let s = origin - a;
    let u = dot(s, p);
    if (u < 0.0 || u > determinant) {
        return none;
    }
    let q = cross(s, e);
    let v = dot(direction, q);
    if (v < 0.0 || u + v > determinant) {
        return none;
    }
    let t = dot(f, q) / determinant;
    if (t > SETTING_NEAR && t < nearest) {
        return Hit(t, slot, vec2(u, v) / determinant, true);
    }
    return none;
}

// The nearest triangle on a ray that is nearer than a distance.
fn tree_hit(origin: vec3<f32>, direction: vec3<f32>, limit: f32) -> Hit {
    var best = Hit(limit, 0u, vec2(0.0), false);
    if (scene.has_tree == 0u) {
        return best;
    }
    let inverse = inverse_of(direction);
    // Parts that wait: place and number of shapes, and where the ray enters.
    var waiting: array<vec2<u32>, TREE_STACK>;
    waiting[0] = vec2(0u, 0u);
    var count = 1u;
    while (count > 0u) {
        count--;
        let part = waiting[count].x;
        if (bitcast<f32>(waiting[count].y) >= best.distance) {
            continue;
        }
        let shapes = part >> 28u;
        let first = part & 0x0fffffffu;
        if (shapes > 0u) {
            for (var slot = first; slot < first + shapes; slot++) {
                let hit = triangle_hit(slot, origin, direction, best.distance);
                if (hit.hits) {
                    best = hit;
                }
            }
            continue;
        }
        let node = 8u * first;
        let ax = (mesh[node] - origin.x) * inverse.x;
        let bx = (mesh[node + 1u] - origin.x) * inverse.x;
        let ay = (mesh[node + 2u] - origin.y) * inverse.y;
        let by = (mesh[node + 3u] - origin.y) * inverse.y;
        let az = (mesh[node + 4u] - origin.z) * inverse.z;
        let bz = (mesh[node + 5u] - origin.z) * inverse.z;
        let near = max(max(max(min(ax, bx), min(ay, by)), min(az, bz)), vec4(0.0));
        let far = min(min(max(ax, bx), max(ay, by)), max(az, bz));
        let parts = bitcast<vec4<u32>>(mesh[node + 6u]);
        let bottom = count;
        for (var lane = 0u; lane < 4u; lane++) {
            if (parts[lane] != TREE_NOTHING && near[lane] <= far[lane] && near[lane] < best.distance && count < TREE_STACK) {
                // The nearest is on top.
                var place = count;
                while (place > bottom && bitcast<f32>(waiting[place - 1u].y) < near[lane]) {
                    waiting[place] = waiting[place - 1u];
                    place--;
                }
                waiting[place] = vec2(parts[lane], bitcast<u32>(near[lane]));
                count++;
            }
        }
    }
    return best;
}
