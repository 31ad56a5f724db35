// Samples of the screen: `x` to the right and `y` down, depth along the line of sight.

// Coordinates along right, up, forward, seen from the eye.
fn local_of(point: vec3<f32>) -> vec3<f32> {
    let p = point - scene.eye;
    return vec3(dot(p, scene.right), dot(p, scene.up), dot(p, scene.forward));
}

// Slopes to the right and up of the ray through the middle of a sample.
fn slopes_of(x: f32, y: f32) -> vec2<f32> {
    return vec2(
        (x + 0.5 - 0.5 * f32(scene.screen_width)) * scene.screen_inverse_focal,
        (0.5 * f32(scene.screen_height) - y - 0.5) * scene.screen_inverse_focal,
    );
}
