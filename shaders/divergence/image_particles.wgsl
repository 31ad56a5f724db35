// #include grid, shares, ball
// For every image in a body, the particles within the support radius; none for those in walls alone. `list[row]` is their number,
// `list[(k + 1) * capacity + row]` the k-th.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> image_grid: Grid;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> starts: array<u32>;
@group(0) @binding(8) var<storage, read_write> image_particles: array<u32>;
@group(0) @binding(9) var<storage, read_write> extremes: array<atomic<u32>>;

var<private> list_row: u32;

fn visit_run(point: vec3<f32>, begin: u32, end: u32) {
    let radius = params.smoothing.support_radius;
    for (var other = begin; other < end; other += 1u) {
        let apart = point - fluid_position[other].xyz;
        if (dot(apart, apart) < radius * radius) {
            if (found < params.image_particle_capacity) {
                image_particles[list_row + (found + 1u) * params.image_capacity] = other;
            }
            found += 1u;
        }
    }
}

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u || is_beyond(group, groups, image_grid.rows)) {
        return;
    }
    let share = shared_row(group, groups, lane, image_grid.rows);
    let capacity = params.image_particle_capacity;
    // A ball without a radius meets no cell.
    let radius = select(params.smoothing.support_radius, 0.0, images[share.row].body == NO_BODY);
    list_row = share.row;
    let length = find(share, lane, image_position[share.row].xyz, radius, capacity);
    if (share.is_last) {
        image_particles[share.row] = length;
        if (length > capacity) {
            atomicMax(&extremes[EXTREME_IMAGE_PARTICLES], length);
        }
    }
}
