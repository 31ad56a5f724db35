// Wrenches of the fluid on bodies: one per body and group of particles. Needs `body`, `surface` and `wrench`. The pass binds
// `body_fluid_wrenches`.

// Where a group has its wrench on a body, and whether it has rows.
fn wrench_slot(group: u32, body: u32) -> u32 {
    return (group * params.body_rows + body) * WRENCH_ROWS;
}

fn has_rows(group: u32) -> bool {
    return group * GROUP_THREADS < params.fluid_rows;
}

// Begins the wrench of a group on a body with the impulses of its threads, which act at these arms. All of its threads take part.
fn begin_wrench(lane: u32, group: u32, body: u32, touches: bool, arm: vec3<f32>, impulse: vec3<f32>) {
    var all = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
    if (group_touches(lane, touches)) {
        all = group_sum(lane, Wrench(impulse, cross(arm, impulse)));
    }
    if (lane == 0u && has_rows(group)) {
        let slot = wrench_slot(group, body);
        body_fluid_wrenches[slot] = vec4<f32>(all.impulse, 0.0);
        body_fluid_wrenches[slot + 1u] = vec4<f32>(all.angular, 0.0);
    }
}

// Adds to that wrench.
fn add_wrench(lane: u32, group: u32, body: u32, touches: bool, arm: vec3<f32>, impulse: vec3<f32>) {
    if (group_touches(lane, touches)) {
        let all = group_sum(lane, Wrench(impulse, cross(arm, impulse)));
        if (lane == 0u && has_rows(group)) {
            let slot = wrench_slot(group, body);
            body_fluid_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
            body_fluid_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
        }
    }
}

// The velocity of a point along the surface of a body.
fn slide_along(body: Body, surface: Surface, point: vec3<f32>, velocity: vec3<f32>) -> vec3<f32> {
    let slide = velocity - body_velocity(body, point);
    return slide - surface.normal * dot(slide, surface.normal);
}
