// Rigid bodies, as in `body.rs`.

fn body_velocity(body: Body, point: vec3<f32>) -> vec3<f32> {
    return body.linear + cross(body.angular, point - body.position);
}
