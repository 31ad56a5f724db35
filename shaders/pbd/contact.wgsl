// #include body, surface, sweep, sponges, wrench
// Contact of nodes with walls and bodies, with friction. Bodies receive the opposite impulse -m dy / h, added to that of
// previous iterations.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(5) var<storage, read> body_states: array<Body>;
@group(0) @binding(6) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> node_predicted: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> body_node_wrenches: array<vec4<f32>>;

// Change of position: out along the normal, and back along the surface as far as friction reaches.
fn contact(depth: f32, normal: vec3<f32>, slide: vec3<f32>, friction: f32) -> vec3<f32> {
    if (depth <= 0.0) {
        return vec3<f32>(0.0);
    }
    let tangent = slide - normal * dot(slide, normal);
    let length = sqrt(dot(tangent, tangent));
    let reach = depth * friction;
    let undone = select(1.0, reach / length, length > reach);
    return normal * depth - tangent * undone;
}

fn wall(point: vec3<f32>, old: vec3<f32>, normal: vec3<f32>, distance: f32, friction: f32) -> vec3<f32> {
    return point + contact(max(-distance, 0.0), normal, point - old, friction);
}

fn walls(start: vec3<f32>, old: vec3<f32>, friction: f32) -> vec3<f32> {
    let low = params.wall_low;
    let high = params.wall_high;
    var point = start;
    point = wall(point, old, vec3<f32>(1.0, 0.0, 0.0), point.x - low.x, friction);
    point = wall(point, old, vec3<f32>(-1.0, 0.0, 0.0), high.x - point.x, friction);
    point = wall(point, old, vec3<f32>(0.0, 1.0, 0.0), point.y - low.y, friction);
    point = wall(point, old, vec3<f32>(0.0, -1.0, 0.0), high.y - point.y, friction);
    point = wall(point, old, vec3<f32>(0.0, 0.0, 1.0), point.z - low.z, friction);
    return wall(point, old, vec3<f32>(0.0, 0.0, -1.0), high.z - point.z, friction);
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
    let is_row = row < params.node_rows;
    var point = vec3<f32>(0.0);
    var old = vec3<f32>(0.0);
    var w = 0.0;
    var clearance = 0.0;
    // Held nodes, sleeping nodes, and those whose own solver handles obstacles stay in place.
    var moves = false;
    if (is_row) {
        point = node_predicted[row].xyz;
        w = node_predicted[row][NODE_PREDICTED_INVERSE_MASS];
        old = node_position[row].xyz;
        clearance = sponges.all[node_sponge[row]].edge * CLEARANCE;
        let sponge = sponges.all[node_sponge[row]];
        moves = w > 0.0 && sponge.solver != SOLVER_VBD && !is_asleep(sponge);
    }
    let meets_walls = is_row && moves && params.has_walls != 0u;
    if (meets_walls) {
        point = walls(point, old, sponges.all[node_sponge[row]].friction);
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        var touches = false;
        var own = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
        for (var index_of_piece = 0u; index_of_piece < body.parts; index_of_piece += 1u) {
            let piece = piece_of(body, index_of_piece);
            let drift = body_velocity(body, point) * clock.step;
            // The body is at its place of the beginning of the step: so is the node, in the body's frame.
            let met = way_meets(piece, clearance, into_body(piece, old), into_body(piece, point - drift));
            let depth = select(0.0, max(-(met.distance + met.beyond), 0.0), moves && body.touches_nodes != 0u);
            let change = contact(depth, out_of_body(piece, met.normal), point - old - drift, body.friction);
            point += change;
            if (depth > 0.0) {
                touches = true;
                let impulse = change * (-1.0 / (w * clock.step));
                own.impulse += impulse;
                own.angular += cross(point - body.position, impulse);
            }
        }
        if (group_touches(lane, touches)) {
            let all = group_sum(lane, own);
            let slot = (group_of(group, groups) * params.body_rows + index) * WRENCH_ROWS;
            if (lane == 0u) {
                body_node_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
                body_node_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
            }
        }
    }
    if (is_row) {
        if (meets_walls) {
            // One obstacle may have pushed into another: walls have the last word.
            point = select(point, params.wall_low, point < params.wall_low);
            point = select(point, params.wall_high, point > params.wall_high);
        }
        node_predicted[row] = vec4<f32>(point, w);
    }
}
