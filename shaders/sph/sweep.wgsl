// #include body, surface, wrench, sweep
// Limits velocities so that no particle passes a body in the step; bodies receive the opposite impulse.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_states: array<Body>;
@group(0) @binding(4) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

// With a solve for the divergence the core of a body, which the ball of `ball_of` sweeps. What has images must not pass the surface that
// they belong to. The parts of a compound are as they are.
fn core_of(body: Body) -> Body {
    var core = body;
    if (params.divergence != 0u) {
        core.extents = select(body.extents, body.core, body.shape == SHAPE_KIND_CUBOID);
        core.size = select(1.0, body.core.x, body.shape == SHAPE_KIND_HULL);
    }
    return core;
}

fn ball_of(body: Body) -> f32 {
    let is_round = body.shape != SHAPE_KIND_CUBOID && body.shape != SHAPE_KIND_HULL;
    return select(body.rounding, 0.0, is_round || params.divergence == 0u);
}

fn is_in_a_part(before: Body, after: Body, gap: f32, start: vec3<f32>, end: vec3<f32>) -> bool {
    var deepest = 0.0;
    for (var piece = 0u; piece < before.parts; piece += 1u) {
        let moved = swept(core_of(piece_of(before, piece)), core_of(piece_of(after, piece)), gap, start, end);
        deepest = max(deepest, dot(moved, moved));
    }
    let slack = PART_SLACK * params.spacing;
    return deepest > slack * slack;
}

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    let is_row = row < params.fluid_rows;
    var start = vec3<f32>(0.0);
    var own = vec4<f32>(0.0);
    if (is_row) {
        start = fluid_position[row].xyz;
        own = fluid_velocity[row];
    }
    let margin = params.spacing * WALL_MARGIN;
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let before = body_states[index];
        let after = at_end(before);
        var touches = false;
        var received = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
        let gap = margin + ball_of(before);
        for (var piece = 0u; is_row && piece < before.parts; piece += 1u) {
            let end = start + clock.step * own.xyz;
            let moved = swept(core_of(piece_of(before, piece)), core_of(piece_of(after, piece)), gap, start, end);
            if (any(moved != vec3<f32>(0.0))) {
                touches = true;
                let change = moved * clock.inverse_step;
                let impulse = change * -params.particle_mass;
                received.impulse += impulse;
                received.angular += cross(end + moved - after.position, impulse);
                own = vec4<f32>(own.xyz + change, own.w);
            }
        }
        // Particles that one part of a compound has moved into another are carried by the body.
        let end = start + clock.step * own.xyz;
        let is_compound = before.shape == SHAPE_KIND_COMPOUND;
        if (is_row && is_compound && is_in_a_part(before, after, gap, start, end)) {
            touches = true;
            let carried = after.position + out_of_body(after, into_body(before, start));
            let change = (carried - end) * clock.inverse_step;
            let impulse = change * -params.particle_mass;
            received.impulse += impulse;
            received.angular += cross(carried - after.position, impulse);
            own = vec4<f32>(own.xyz + change, own.w);
        }
        if (group_touches(lane, touches)) {
            let all = group_sum(lane, received);
            let slot = (group_of(group, groups) * params.body_rows + index) * 2u;
            if (lane == 0u) {
                body_fluid_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
                body_fluid_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
            }
        }
    }
    if (is_row) {
        fluid_velocity[row] = own;
    }
}
