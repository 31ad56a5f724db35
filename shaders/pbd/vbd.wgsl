// #include body, surface, sweep, sponges, descent, shares
// Vertex block descent for the nodes of one vertex colour; `vbd.rs` has the formulas. Neighbours have other colours.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> batch: Batch;
@group(0) @binding(4) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_target: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> node_stars: array<u32>;
@group(0) @binding(7) var<storage, read> body_states: array<Body>;
@group(0) @binding(8) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_predicted: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let share = shared_row(group, groups, lane, batch.count);
    let row = batch.first + share.row;
    let sponge = sponges.all[node_stars[row * STAR_WORDS + STAR_SPONGE]];
    let x = node_predicted[row];
    let moves = x[NODE_PREDICTED_INVERSE_MASS] > 0.0 && sponge.solver == SOLVER_VBD;
    let old = node_position[row].xyz;
    var part = no_energy();
    if (moves) {
        part = material_energy(row, x.xyz, old, sponge, clock.step, share.first, SHARES);
    }
    let material = all_of(lane, part);
    if (!moves || !share.writes) {
        return;
    }
    let local = with_touch(row, material);
    let quadratic = minimum(local, x.xyz, node_target[row], clock.step);
    var relaxation = 1.0;
    let edges = quadratic.way / sponge.edge;
    let short = (NO_RELAXATION_WAY * NO_RELAXATION_WAY - dot(edges, edges)) * 4.0 / (3.0 * NO_RELAXATION_WAY * NO_RELAXATION_WAY);
    if (sponge.iterations > 1u) {
        let strain_range = NO_RELAXATION_STRAIN - FULL_RELAXATION_STRAIN;
        relaxation += RELAXATION * clamp(min((NO_RELAXATION_STRAIN - local.strain) / strain_range, short), 0.0, 1.0);
    }
    let relaxed = moved(x.xyz, quadratic.way * relaxation);
    var start = relaxed;
    var point = relaxed;
    // Obstacles stand at one place of the text: what is inlined twice takes long to compile.
    for (var round = 0u; round < 2u; round += 1u) {
        point = pushed(quadratic, start, old, sponge);
        let off = point - start;
        if (!(dot(off, off) > 0.0)) {
            break;
        }
        // The contact force is that of the minimum, without over-relaxation.
        start = moved(x.xyz, quadratic.way);
    }
    node_predicted[row] = with_vector(x, point);
}

fn no_energy() -> Local {
    return Local(vec3<f32>(0.0), mat3x3<f32>(), 0.0);
}

// The sums over the threads of a node, whose stiffness is symmetric.
fn all_of(lane: u32, part: Local) -> Local {
    let force = share_sum3(lane, part.force);
    let on = share_sum3(lane, vec3<f32>(part.stiffness[0].x, part.stiffness[1].y, part.stiffness[2].z));
    let off = share_sum3(lane, vec3<f32>(part.stiffness[1].z, part.stiffness[0].z, part.stiffness[0].y));
    let stiffness = mat3x3<f32>(
        vec3<f32>(on.x, off.z, off.y),
        vec3<f32>(off.z, on.y, off.x),
        vec3<f32>(off.y, off.x, on.z),
    );
    return Local(force, stiffness, share_maximum(lane, part.strain));
}

// Adds a way to a point with stochastic rounding, with a probability in proportion to the remainder; see `vbd.rs`.
fn moved(point: vec3<f32>, way: vec3<f32>) -> vec3<f32> {
    let digit = max(abs(point), vec3<f32>(MINIMUM_COORDINATE)) * EPSILON;
    let parts = way / digit * ROUNDING_PARTS + 0.5;
    return point + (way + (parts - floor(parts) - 0.5) * digit);
}

// Position of a point after all obstacles.
fn pushed(quadratic: Quadratic, start: vec3<f32>, old: vec3<f32>, sponge: Sponge) -> vec3<f32> {
    let low = params.wall_low;
    let high = params.wall_high;
    let has_walls = params.has_walls != 0u;
    var point = start;
    var friction = sponge.friction;
    var bodies = params.body_rows;
    for (var round = 0u; round < 2u; round += 1u) {
        if (has_walls) {
            point += push_by_walls(low, high, quadratic, point, old, friction).change;
        }
        for (var index = 0u; index < bodies; index += 1u) {
            point += push_by_body(body_states[index], quadratic, point, old, sponge.edge * CLEARANCE, clock.step).change;
        }
        friction = 0.0;
        bodies = 0u;
    }
    if (has_walls) {
        // One obstacle may push a node into another: walls come last.
        point = select(point, low, point < low);
        point = select(point, high, point > high);
    }
    return point;
}
