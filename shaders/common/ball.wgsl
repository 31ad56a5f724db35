// Runs of points in the cells that a ball intersects. Needs `grid`. The pass binds `grid` and `starts`. It declares what it has `Found` so
// far, and how a run adds to that: `visit_run(found, point, begin, end)`, with the ball around `point`.

// By one of some threads, which take the lines of cells by turns.
fn visit_ball(before: Found, point: vec3<f32>, radius: f32, part: u32, parts: u32) -> Found {
    var found = before;
    let cell_square = radius * radius * grid.inverse_edge * grid.inverse_edge;
    let reach = radius * grid.inverse_edge;
    let at = vec3<f32>(
        coordinate_of(grid, point.x, 0u),
        coordinate_of(grid, point.y, 1u),
        coordinate_of(grid, point.z, 2u),
    );
    let span_y = cells_around(grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(grid, at.z, reach + slack(at.z), 2u);
    var y = span_y.x + i32(part);
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        let dz = slab_distance(grid, at.z, z, 2u);
        let plane = wrapped(grid, z, 2u) * grid.size.y;
        for (; y <= span_y.y; y += i32(parts)) {
            let dy = slab_distance(grid, at.y, y, 1u);
            let chord = cell_square - dy * dy - dz * dz;
            if (chord <= 0.0) {
                continue;
            }
            let line = (plane + wrapped(grid, y, 1u)) * grid.size.x;
            let span_x = cells_around(grid, at.x, sqrt(chord) + slack(at.x), 0u);
            var x = span_x.x;
            // One run, or two where it crosses the end of the torus.
            while (x <= span_x.y) {
                let first = wrapped(grid, x, 0u);
                let last = min(first + u32(span_x.y - x), grid.size.x - 1u);
                x += i32(last - first) + 1;
                found = visit_run(found, point, starts[line + first], starts[line + last + 1u]);
            }
        }
        y -= span_y.y - span_y.x + 1;
    }
    return found;
}
