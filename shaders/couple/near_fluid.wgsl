// #include grid, shares
// For every particle, the controls within the coupling radius; the list has the layout of `fluid_neighbors.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> control_grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_starts: array<u32>;
@group(0) @binding(6) var<storage, read_write> fluid_controls: array<u32>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

// Visits the lines of cells of one thread; the list goes on at `slot`. The number of controls.
fn visit(row: u32, part: u32, slot: u32) -> u32 {
    let point = fluid_position[row].xyz;
    let radius = params.coupling.support_radius;
    let square = radius * radius;
    let cell_square = square * control_grid.inverse_edge * control_grid.inverse_edge;
    let reach = radius * control_grid.inverse_edge;
    let at = vec3<f32>(
        coordinate_of(control_grid, point.x, 0u),
        coordinate_of(control_grid, point.y, 1u),
        coordinate_of(control_grid, point.z, 2u),
    );
    let span_y = cells_around(control_grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(control_grid, at.z, reach + slack(at.z), 2u);
    var count = 0u;
    // Threads of a row take its lines of cells by turns.
    var y = span_y.x + i32(part);
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        let dz = slab_distance(control_grid, at.z, z, 2u);
        let plane = wrapped(control_grid, z, 2u) * control_grid.size.y;
        for (; y <= span_y.y; y += i32(SHARES)) {
            let dy = slab_distance(control_grid, at.y, y, 1u);
            let chord = cell_square - dy * dy - dz * dz;
            if (chord <= 0.0) {
                continue;
            }
            let line = (plane + wrapped(control_grid, y, 1u)) * control_grid.size.x;
            let span_x = cells_around(control_grid, at.x, sqrt(chord) + slack(at.x), 0u);
            var x = span_x.x;
            // One run, or two where it crosses the end of the torus.
            while (x <= span_x.y) {
                let first = wrapped(control_grid, x, 0u);
                let last = min(first + u32(span_x.y - x), control_grid.size.x - 1u);
                x += i32(last - first) + 1;
                let end = control_starts[line + last + 1u];
                for (var other = control_starts[line + first]; other < end; other += 1u) {
                    let apart = point - control_position[other].xyz;
                    if (dot(apart, apart) < square) {
                        if (slot + count < params.control_capacity) {
                            fluid_controls[row + (slot + count + 1u) * params.fluid_rows] = other;
                        }
                        count += 1u;
                    }
                }
            }
        }
        y -= span_y.y - span_y.x + 1;
    }
    return count;
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let share = shared_row(group, groups, lane, params.fluid_rows);
    var slot = 0u;
    if (SHARES > 1u) {
        // Threads that share a row count first.
        slot = share_before(lane, visit(share.row, share.first, params.control_capacity));
    }
    let found = slot + visit(share.row, share.first, select(params.control_capacity, slot, share.is_row));
    if (share.is_row && share.first == SHARES - 1u) {
        fluid_controls[share.row] = found;
        if (found > params.control_capacity) {
            atomicMax(&extremes[EXTREME_CONTROLS], found);
        }
    }
}
