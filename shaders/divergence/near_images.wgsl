// #include grid, shares, ball, near, near_list
// For every particle, the images within the support radius.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> grid: Grid;
@group(0) @binding(3) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> targets: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> starts: array<u32>;
@group(0) @binding(6) var<storage, read> image_order: array<u32>;
@group(0) @binding(7) var<storage, read_write> list: array<u32>;
@group(0) @binding(8) var<storage, read_write> extremes: array<atomic<u32>>;

fn lists() -> Lists {
    return Lists(params.fluid_rows, params.near_image_capacity, params.smoothing.support_radius);
}

fn target_at(place: u32) -> u32 {
    return image_order[place];
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
    list_near(share, lane, fluid_position[share.row].xyz, params.smoothing.support_radius, EXTREME_NEAR_IMAGES);
}
