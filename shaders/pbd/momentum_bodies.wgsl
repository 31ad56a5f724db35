// #include body, surface, sponges, wrench
// Impulses of walls, bodies and grips on the nodes that stay in place while their sponge receives its rigid motion;
// `momentum.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(6) var<storage, read> sponge_motions: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> body_states: array<Body>;
@group(0) @binding(8) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_reaction: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> body_node_wrenches: array<vec4<f32>>;

// The nearest body at the end of the step, if it is that near; else a row beyond all bodies.
fn touched(point: vec3<f32>, margin: f32) -> u32 {
    var found = params.body_rows;
    var minimum = margin;
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        // The body is at its place of the beginning of the step, and so is the point in the body's frame.
        let distance = body_surface(body, point - body_velocity(body, point) * clock.step).distance;
        if (body.touches_nodes != 0u && distance < minimum) {
            found = index;
            minimum = distance;
        }
    }
    return found;
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
    var body = params.body_rows;
    var impulse = vec3<f32>(0.0);
    var old = vec3<f32>(0.0);
    if (row < params.node_rows) {
        let sponge = node_sponge[row];
        let before = node_reaction[row];
        if (before[NODE_REACTION_MASS] < 0.0 && sponges.all[sponge].solver == SOLVER_VBD) {
            old = node_position[row].xyz;
            let turn = cross(sponge_motions[sponge * MOTION_ROWS + 2u].xyz, old - sponge_motions[sponge * MOTION_ROWS].xyz);
            impulse = (sponge_motions[sponge * MOTION_ROWS + 1u].xyz + turn) * -before[NODE_REACTION_MASS];
            node_reaction[row] = with_vector(before, before.xyz - impulse);
            if (node_predicted[row][NODE_PREDICTED_INVERSE_MASS] > 0.0) {
                body = touched(node_predicted[row].xyz, sponges.all[sponge].edge * OBSTACLE_MARGIN);
            }
        }
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        if (group_touches(lane, body == index)) {
            let own = select(vec3<f32>(0.0), impulse, body == index);
            let all = group_sum(lane, Wrench(own, cross(old - body_states[index].position, own)));
            let slot = (group_of(group, groups) * params.body_rows + index) * WRENCH_ROWS;
            if (lane == 0u) {
                body_node_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
                body_node_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
            }
        }
    }
}
