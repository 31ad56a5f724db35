// Runs of points in the cells that a ball intersects, periodic images included. Needs `grid` and `shares`. The pass binds `grid` and
// `starts`, and says what it does with a run: `visit_run(point, begin, end)`, with the ball around `point`.

// Number of entries of a list with those of this thread so far. From its capacity on none is stored.
var<private> found: u32;

fn visit_ball(point: vec3<f32>, radius: f32, part: u32) {
    let cell_square = radius * radius * grid.inverse_edge * grid.inverse_edge;
    let reach = radius * grid.inverse_edge;
    let at = vec3<f32>(
        coordinate_of(grid, point.x, 0u),
        coordinate_of(grid, point.y, 1u),
        coordinate_of(grid, point.z, 2u),
    );
    let span_y = cells_around(grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(grid, at.z, reach + slack(at.z), 2u);
    // Threads of a row take its lines of cells by turns.
    var y = span_y.x + i32(part);
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        let dz = slab_distance(grid, at.z, z, 2u);
        let plane = wrapped(grid, z, 2u) * grid.size.y;
        for (; y <= span_y.y; y += i32(SHARES)) {
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
                visit_run(point, starts[line + first], starts[line + last + 1u]);
            }
        }
        y -= span_y.y - span_y.x + 1;
    }
}

// Whether images of the box come near a point: those before it (-1) and those behind it (1) along periodic axes.
fn touches_box(point: vec3<f32>, radius: f32, image: vec3<f32>) -> bool {
    let before = point - radius <= params.period_low;
    let behind = point + radius >= params.period_high;
    let near = select(before, behind, image > vec3<f32>(0.0)) & (params.periods > vec3<f32>(0.0));
    return all(near | (image == vec3<f32>(0.0)));
}

// The part of one of the threads that share a row.
fn visit_near(point: vec3<f32>, radius: f32, part: u32) {
    // The box itself first, then its images.
    let images = select(1u, 27u, params.has_periods != 0u);
    for (var index = 0u; index < images; index += 1u) {
        let place = vec3<f32>(vec3<u32>(index % 3u, index / 3u % 3u, index / 9u));
        let image = select(place, vec3<f32>(-1.0), place > vec3<f32>(1.0));
        if (index == 0u || touches_box(point, radius, image)) {
            visit_ball(point - image * params.periods, radius, part);
        }
    }
}

// Finds the entries of the list of a row, threads of the row by turns. They count first, so that each knows where its own begin. In the
// last of them it is the length of the list.
fn find(share: SharedRow, lane: u32, point: vec3<f32>, radius: f32, capacity: u32) -> u32 {
    var before = 0u;
    if (SHARES > 1u) {
        found = capacity;
        visit_near(point, radius, share.first);
        before = share_before(lane, found - capacity);
    }
    found = select(capacity, before, share.is_row);
    visit_near(point, radius, share.first);
    return found;
}
