// #include grid, ball
// For every control, the particles within the coupling radius. Thirty-two threads share a control: each takes some rows of
// cells, and knows the slots of its entries once all have counted.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> control_fluid: array<u32>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

var<workgroup> counted: array<u32, GROUP_THREADS>;

struct Found {
    count: u32,
    // Where the next one is written, up to the last place.
    slot: u32,
    last: u32,
}

fn visit_run(before: Found, point: vec3<f32>, begin: u32, end: u32) -> Found {
    var found = before;
    let radius = params.coupling.support_radius;
    for (var other = begin; other < end; other += 1u) {
        let apart = point - fluid_position[other].xyz;
        if (dot(apart, apart) < radius * radius) {
            if (found.slot <= found.last) {
                control_fluid[found.slot] = other;
            }
            found.slot += 1u;
            found.count += 1u;
        }
    }
    return found;
}

// Counts what a thread finds, and writes it from a slot on, up to `last` if that is not before it.
fn visit(point: vec3<f32>, sub: u32, slot: u32, last: u32) -> u32 {
    return visit_ball(Found(0u, slot, last), point, params.coupling.support_radius, sub, CONTROL_THREADS).count;
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
    let row = group_of(group, groups) * CONTROLS_PER_GROUP + lane / CONTROL_THREADS;
    let is_row = row < params.node_rows;
    let query = control_position[min(row, params.node_rows - 1u)];
    let point = query.xyz;
    let sub = lane % CONTROL_THREADS;
    var own = 0u;
    // A node of a sleeping sponge has no volume, and no particle near it.
    if (is_row && query[CONTROL_POSITION_VOLUME] > 0.0) {
        own = visit(point, sub, 1u, 0u);
    }
    counted[lane] = own;
    workgroupBarrier();
    var before = 0u;
    for (var other = lane - sub; other < lane; other += 1u) {
        before += counted[other];
    }
    if (!is_row) {
        return;
    }
    let capacity = params.control_fluid_capacity;
    let first = row * (capacity + 1u);
    if (own > 0u) {
        own = visit(point, sub, first + 1u + before, first + capacity);
    }
    if (sub == CONTROL_THREADS - 1u) {
        let all = before + own;
        control_fluid[first] = all;
        if (all > capacity) {
            atomicMax(&extremes[EXTREME_CONTROL_FLUID], all);
        }
    }
}
