// #include grid, smoothing, shares, ball, near
// For every particle, the particles within the support radius, periodic images included. The pass also sums the density,
// which `sph::density` computes from the lists.
//
// Rows of cells along x that the support sphere intersects are runs of particles, as long as the chord of the sphere there.
// `list[row]` is the number of neighbours, `list[(k + 1) * rows + row]` the k-th.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> starts: array<u32>;
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
fn visit_run(before: Found, point: vec3<f32>, begin: u32, end: u32) -> Found {
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

fn begin_list(own: u32, count: u32) -> Found {
    return Found(count, own + count * params.fluid_rows, 0.0);
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
    let found = find(share, lane, point, params.list_radius, params.neighbor_capacity);
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
