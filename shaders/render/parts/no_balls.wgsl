// For views of surfaces: nothing but those is there.

fn ball_on(origin: vec3<f32>, direction: vec3<f32>, nearest: Matter) -> Matter {
    return nearest;
}

fn ball_colour(ball: u32) -> vec3<f32> {
    return vec3(1.0);
}
