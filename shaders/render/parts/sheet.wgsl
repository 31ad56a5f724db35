// The surface of the water of the fast view on a ray.
struct Sheet {
    depth: f32,
    thickness: f32,
    normal: vec3<f32>,
    is_there: bool,
    // Where the ray meets it, how it goes on, and the shares that it mirrors and bends.
    point: vec3<f32>,
    below: vec3<f32>,
    mirrored: f32,
    strength: f32,
}

fn no_sheet() -> Sheet {
    return Sheet(FAR_AWAY, 0.0, vec3(0.0), false, vec3(0.0), vec3(0.0), 0.0, 0.0);
}
