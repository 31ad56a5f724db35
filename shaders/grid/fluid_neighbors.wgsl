// #include grid, smoothing, shares
// For every particle, the particles within the support radius, periodic images included. The pass also sums the density,
// which `sph::density` computes from the lists.
//
// Rows of cells along x that the support sphere intersects are runs of particles, as long as the chord of the sphere there.
// `list[row]` is the number of neighbours, `list[(k + 1) * rows + row]` the k-th.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> fluid_grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_starts: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_neighbors: array<u32>;
@group(0) @binding(6) var<storage, read_write> fluid_density: array<f32>;
@group(0) @binding(7) var<storage, read_write> extremes: array<atomic<u32>>;

struct Found {
    // In the list so far, and where the last of them is.
    count: u32,
    place: u32,
    // Of the shapes.
    sum: f32,
}

// Adds the particles near a point from a run of rows.
fn add_run(before: Found, point: vec3<f32>, begin: u32, end: u32) -> Found {
    var found = before;
    let square = params.list_radius * params.list_radius;
    for (var other = begin; other < end; other += 1u) {
        let apart = point - fluid_position[other].xyz;
        let distance_square = dot(apart, apart);
        if (distance_square < square) {
            if (found.count < params.neighbor_capacity) {
                found.place += params.fluid_rows;
                fluid_neighbors[found.place] = other;
            }
            found.count += 1u;
            found.sum += shape(closeness(params.smoothing, distance_square));
        }
    }
    return found;
}

// Adds the particles near a point, from the lines of cells of one thread.
fn add_ball(before: Found, point: vec3<f32>, part: u32) -> Found {
    var found = before;
    let radius = params.list_radius;
    let cell_square = radius * radius * fluid_grid.inverse_edge * fluid_grid.inverse_edge;
    let reach = radius * fluid_grid.inverse_edge;
    let at = vec3<f32>(
        coordinate_of(fluid_grid, point.x, 0u),
        coordinate_of(fluid_grid, point.y, 1u),
        coordinate_of(fluid_grid, point.z, 2u),
    );
    let span_y = cells_around(fluid_grid, at.y, reach + slack(at.y), 1u);
    let span_z = cells_around(fluid_grid, at.z, reach + slack(at.z), 2u);
    // Threads of a row take its lines of cells by turns.
    var y = span_y.x + i32(part);
    for (var z = span_z.x; z <= span_z.y; z += 1) {
        let dz = slab_distance(fluid_grid, at.z, z, 2u);
        let plane = wrapped(fluid_grid, z, 2u) * fluid_grid.size.y;
        for (; y <= span_y.y; y += i32(SHARES)) {
            let dy = slab_distance(fluid_grid, at.y, y, 1u);
            let chord = cell_square - dy * dy - dz * dz;
            if (chord <= 0.0) {
                continue;
            }
            let line = (plane + wrapped(fluid_grid, y, 1u)) * fluid_grid.size.x;
            let span_x = cells_around(fluid_grid, at.x, sqrt(chord) + slack(at.x), 0u);
            var x = span_x.x;
            // One run, or two where it crosses the end of the torus.
            while (x <= span_x.y) {
                let first = wrapped(fluid_grid, x, 0u);
                let last = min(first + u32(span_x.y - x), fluid_grid.size.x - 1u);
                x += i32(last - first) + 1;
                let end = fluid_starts[line + last + 1u];
                found = add_run(found, point, fluid_starts[line + first], end);
            }
        }
        y -= span_y.y - span_y.x + 1;
    }
    return found;
}

// Whether images of the box come near a point: those before it (-1) and those behind it (1) along periodic axes.
fn touches(point: vec3<f32>, image: vec3<f32>) -> bool {
    let before = point - params.list_radius <= params.period_low;
    let behind = point + params.list_radius >= params.period_high;
    let near = select(before, behind, image > vec3<f32>(0.0)) & (params.periods > vec3<f32>(0.0));
    return all(near | (image == vec3<f32>(0.0)));
}

// What a thread finds of a row whose list has `count` entries before; none is stored where the list is full.
fn search(row: u32, point: vec3<f32>, part: u32, count: u32) -> Found {
    var found = Found(count, row + count * params.fluid_rows, 0.0);
    // The box itself first, then its images.
    let images = select(1u, 27u, params.has_periods != 0u);
    for (var index = 0u; index < images; index += 1u) {
        let place = vec3<f32>(vec3<u32>(index % 3u, index / 3u % 3u, index / 9u));
        let image = select(place, vec3<f32>(-1.0), place > vec3<f32>(1.0));
        if (index == 0u || touches(point, image)) {
            found = add_ball(found, point - image * params.periods, part);
        }
    }
    return found;
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
    let point = fluid_position[share.row].xyz;
    let full = params.neighbor_capacity;
    var before = 0u;
    if (SHARES > 1u) {
        // Threads that share a row count first.
        before = share_before(lane, search(share.row, point, share.first, full).count - full);
    }
    let found = search(share.row, point, share.first, select(full, before, share.is_row));
    let sum = share_sum(lane, vec4<f32>(found.sum, 0.0, 0.0, 0.0)).x;
    if (share.writes) {
        fluid_density[share.row] = sum * (params.smoothing.value * params.particle_mass);
    }
    if (share.is_last) {
        fluid_neighbors[share.row] = found.count;
        if (found.count > params.neighbor_capacity) {
            atomicMax(&extremes[EXTREME_NEIGHBORS], found.count);
        }
    }
}
