// #include grid, shares, ball, near, near_list
// For every image in a body, the particles within the support radius; none for those in walls alone.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> image_grid: Grid;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> targets: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> starts: array<u32>;
@group(0) @binding(8) var<storage, read_write> list: array<u32>;
@group(0) @binding(9) var<storage, read_write> extremes: array<atomic<u32>>;

fn lists() -> Lists {
    return Lists(params.image_capacity, params.image_particle_capacity, params.smoothing.support_radius);
}

fn target_at(place: u32) -> u32 {
    return place;
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
    // A ball without a radius meets no cell.
    let radius = select(params.smoothing.support_radius, 0.0, images[share.row].body == NO_BODY);
    list_near(share, lane, image_position[share.row].xyz, radius, EXTREME_IMAGE_PARTICLES);
}
