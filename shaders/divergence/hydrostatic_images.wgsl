// #include smoothing, images, image, shares, push_on_image, hydrostatic
// First pass of `divergence::hydrostatic`: what images in bodies receive.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> image_grid: Grid;
@group(0) @binding(3) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> image_particles: array<u32>;
@group(0) @binding(7) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> image_forces: array<vec4<f32>>;

fn pressure_of(there: vec4<f32>) -> f32 {
    return 1.0;
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
    let row = share.row;
    let point = image_position[row];
    let all = push_on_image(share, lane, point.xyz);
    if (share.writes) {
        let d = difference(point.xyz - points[images[row].source].xyz);
        image_forces[row] = vec4<f32>(all * (point[IMAGE_RATIO] * d), 0.0);
    }
}
