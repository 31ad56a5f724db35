// #include body, surface, sweep, sponges, wrench, descent
// What walls, bodies and grips gave to the nodes of vertex block descent; `reaction.rs` has the rules.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_target: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_stars: array<u32>;
@group(0) @binding(7) var<storage, read> body_states: array<Body>;
@group(0) @binding(8) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_reaction: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> body_node_wrenches: array<vec4<f32>>;

fn is_near(point: vec3<f32>, old: vec3<f32>, margin: f32) -> bool {
    if (params.has_walls != 0u) {
        let low = point - params.wall_low;
        let high = params.wall_high - point;
        let minimum = min(low, high);
        if (min(minimum.x, min(minimum.y, minimum.z)) < margin) {
            return true;
        }
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        let drift = body_velocity(body, point) * clock.step;
        let way = point - drift - old;
        if (body.touches_nodes != 0u && body_surface(body, old).distance - sqrt(dot(way, way)) < margin) {
            return true;
        }
    }
    return false;
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
    var x = vec4<f32>(0.0);
    var old = vec3<f32>(0.0);
    var sponge = sponges.all[0];
    var counts = false;
    if (row < params.node_rows) {
        x = node_predicted[row];
        old = node_position[row].xyz;
        sponge = sponges.all[node_stars[row * STAR_WORDS + STAR_SPONGE]];
        counts = sponge.solver == SOLVER_VBD;
    }
    let free = x[NODE_PREDICTED_INVERSE_MASS] > 0.0;
    let near = counts && free && is_near(x.xyz, old, sponge.edge * OBSTACLE_MARGIN);
    var local = Local(vec3<f32>(0.0), diagonal(1.0), 0.0);
    var quadratic = Quadratic(vec3<f32>(0.0), diagonal(1.0), diagonal(1.0));
    if (near || (counts && !free)) {
        local = local_energy(row, x.xyz, old, sponge, clock.step);
    }
    if (near) {
        quadratic = minimum(local, x.xyz, node_target[row], clock.step);
    }
    let low = params.wall_low;
    let high = params.wall_high;
    let meets_walls = near && params.has_walls != 0u;
    var point = x.xyz + quadratic.way;
    var force = vec3<f32>(0.0);
    if (meets_walls) {
        let pushed = push_by_walls(low, high, quadratic, point, old, sponge.friction);
        point += pushed.change;
        force += pushed.force;
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        var pushed = Reaction(vec3<f32>(0.0), vec3<f32>(0.0));
        if (near) {
            pushed = push_by_body(body_states[index], quadratic, point, old, sponge.edge * CLEARANCE, clock.step);
        }
        point += pushed.change;
        force += pushed.force;
        if (group_touches(lane, any(pushed.force != vec3<f32>(0.0)))) {
            let impulse = pushed.force * -clock.step;
            let all = group_sum(lane, Wrench(impulse, cross(old - body_states[index].position, impulse)));
            let slot = (group_of(group, groups) * params.body_rows + index) * WRENCH_ROWS;
            if (lane == 0u) {
                body_node_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
                body_node_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
            }
        }
    }
    if (meets_walls) {
        force += push_by_walls(low, high, quadratic, point, old, 0.0).force;
    }
    if (counts && !free) {
        force = -local.force;
    }
    if (row < params.node_rows) {
        var mass = 0.0;
        if (counts && free) {
            mass = 1.0 / x[NODE_PREDICTED_INVERSE_MASS];
        }
        if (counts && (!free || any(force != vec3<f32>(0.0)))) {
            let trace = local.stiffness[0].x + local.stiffness[1].y + local.stiffness[2].z;
            mass = -trace / 3.0 * (clock.step * clock.step);
        }
        node_reaction[row] = vec4<f32>(force * clock.step, mass);
    }
}
