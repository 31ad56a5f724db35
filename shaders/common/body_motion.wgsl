// What impulses do to a body. Needs `wrench`. The pass binds `wrenches`.

// The impulses of all groups of particles, valid in thread 0.
fn total_wrench(body: u32, lane: u32) -> Wrench {
    var own = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
    let groups = (params.fluid_rows + GROUP_THREADS - 1u) / GROUP_THREADS;
    for (var k = lane; k < groups; k += GROUP_THREADS) {
        let slot = (k * params.body_rows + body) * WRENCH_ROWS;
        own.impulse += wrenches[slot].xyz;
        own.angular += wrenches[slot + 1u].xyz;
    }
    return group_sum(lane, own);
}

fn turned_by(body: Body, v: vec3<f32>) -> vec3<f32> {
    return v.x * body.inverse_inertia_x + v.y * body.inverse_inertia_y + v.z * body.inverse_inertia_z;
}
