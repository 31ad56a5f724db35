// #include grid
// For every control, the particles within the coupling radius. Thirty-two threads share a control: each takes some rows of
// cells, and knows the slots of its entries once all have counted.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> fluid_grid: Grid;
@group(0) @binding(3) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> control_fluid: array<u32>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

var<workgroup> found: array<u32, GROUP_THREADS>;

// Visits the rows of cells of one thread. It counts the points within the radius, and writes them from `slot` on, up to `last` if that is
// not before it.
fn visit(point: vec3<f32>, sub: u32, slot: u32, last: u32) -> u32 {
    let radius = params.coupling.support_radius;
    let square = radius * radius;
    let cell_square = square * fluid_grid.inverse_edge * fluid_grid.inverse_edge;
    let reach = radius * fluid_grid.inverse_edge;
    let at = vec3<f32>(
        coordinate_of(fluid_grid, point.x, 0u),
        coordinate_of(fluid_grid, point.y, 1u),
        coordinate_of(fluid_grid, point.z, 2u),
    );
    let span_y = cells_around(fluid_grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(fluid_grid, at.z, reach + slack(at.z), 2u);
    let wide = span_y.y - span_y.x + 1;
    let lines = wide * (span_z.y - span_z.x + 1);
    var count = 0u;
    for (var index = i32(sub); index < lines; index += 32) {
        let z = span_z.x + index / wide;
        let y = span_y.x + index % wide;
        let dz = slab_distance(fluid_grid, at.z, z, 2u);
        let dy = slab_distance(fluid_grid, at.y, y, 1u);
        let chord = cell_square - dy * dy - dz * dz;
        if (chord <= 0.0) {
            continue;
        }
        let line = (wrapped(fluid_grid, z, 2u) * fluid_grid.size.y + wrapped(fluid_grid, y, 1u)) * fluid_grid.size.x;
        let span_x = cells_around(fluid_grid, at.x, sqrt(chord) + slack(at.x), 0u);
        var x = span_x.x;
        // One run, or two where it crosses the end of the torus.
        while (x <= span_x.y) {
            let first = wrapped(fluid_grid, x, 0u);
            let end_cell = min(first + u32(span_x.y - x), fluid_grid.size.x - 1u);
            x += i32(end_cell - first) + 1;
            let end = fluid_starts[line + end_cell + 1u];
            for (var other = fluid_starts[line + first]; other < end; other += 1u) {
                let apart = point - fluid_position[other].xyz;
                if (dot(apart, apart) < square) {
                    if (slot + count <= last) {
                        control_fluid[slot + count] = other;
                    }
                    count += 1u;
                }
            }
        }
    }
    return count;
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
    found[lane] = own;
    workgroupBarrier();
    var before = 0u;
    for (var other = lane - sub; other < lane; other += 1u) {
        before += found[other];
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
