// #include smoothing, images, image, shares
// What the images in walls, which mirror the pressure, add to the velocities.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> images: array<Image>;
@group(0) @binding(5) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_correction: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    let point = fluid_predicted[row].xyz;
    var sum = vec3<f32>(0.0);
    let end = fluid_near_images[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let image = images[other];
        if (image.body != NO_BODY) {
            continue;
        }
        let apart = apart_from(point, image_position[other].xyz);
        let along = fluid_renormalisation[image.source].xyz;
        let between = mirrored_between(image, fluid_renormalisation_between[image.source].xyz);
        sum += (pair_factor(apart) * fluid_predicted[image.source][FLUID_PREDICTED_PRESSURE]) * symmetric_times(along, between, apart);
    }
    let all = share_sum3(lane, sum);
    if (share.writes) {
        fluid_correction[row] += vec4<f32>(clock.step * all, 0.0);
    }
}
