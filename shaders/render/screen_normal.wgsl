// #include numbers, scene, raster
// Normals of the water on the screen, in the axes of the raster.

@group(0) @binding(1) var<storage, read> water: array<vec4<f32>>;
// Normal against the eye.
@group(0) @binding(2) var<storage, read_write> sheets: array<vec4<f32>>;

fn depth_at(x: u32, y: u32) -> f32 {
    return water[y * scene.screen_width + x].x;
}

fn place_of(x: u32, y: u32) -> vec3<f32> {
    return vec3(slopes_of(f32(x), f32(y)), 1.0) * depth_at(x, y);
}

// Between neighbours on the same sheet.
fn difference(own: vec2<u32>, step: vec2<u32>, limit: u32, place: u32) -> vec3<f32> {
    let here = depth_at(own.x, own.y);
    let before = own - step;
    let after = own + step;
    var has_before = false;
    var has_after = false;
    if (place > 0u) {
        has_before = abs(depth_at(before.x, before.y) - here) < scene.spacing;
    }
    if (place + 1u < limit) {
        has_after = abs(depth_at(after.x, after.y) - here) < scene.spacing;
    }
    if (has_before && has_after) {
        return place_of(after.x, after.y) - place_of(before.x, before.y);
    }
    if (has_before) {
        return place_of(own.x, own.y) - place_of(before.x, before.y);
    }
    if (has_after) {
        return place_of(after.x, after.y) - place_of(own.x, own.y);
    }
    return vec3(0.0);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if (id.x >= scene.screen_width || id.y >= scene.screen_height) {
        return;
    }
    var normal = vec3(0.0, 0.0, -1.0);
    if (is_near(depth_at(id.x, id.y))) {
        let across = difference(id.xy, vec2(1u, 0u), scene.screen_width, id.x);
        let down = difference(id.xy, vec2(0u, 1u), scene.screen_height, id.y);
        normal = unit_or(cross(down, across), normal);
        if (normal.z > 0.0) {
            normal = -normal;
        }
    }
    sheets[id.y * scene.screen_width + id.x] = vec4(normal, 0.0);
}
