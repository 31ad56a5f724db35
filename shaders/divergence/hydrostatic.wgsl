// #include smoothing, images, image, shares, hydrostatic
// Second pass of `divergence::hydrostatic`: by the images in the list of the particle, and by the counterparts of those in walls.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> images: array<Image>;
@group(0) @binding(5) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

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
    let point = fluid_position[row].xyz;
    var own = vec3<f32>(0.0);
    var mirrored = vec3<f32>(0.0);
    let end = fluid_near_images[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let image = images[other];
        let there = image_position[other];
        let apart = apart_from(point, there.xyz);
        let push = (there[IMAGE_RATIO] * pair_factor(apart)) * apart;
        own += push * difference(there.xyz - fluid_position[image.source].xyz);
        if (image.body == NO_BODY) {
            let signs = signs_of(image);
            let walls = there.xyz - signs * image.foot;
            let along = fluid_renormalisation[image.source].xyz;
            let between = mirrored_between(image, fluid_renormalisation_between[image.source].xyz);
            mirrored += symmetric_times(along, between, push) * difference(walls + (signs - 1.0) * point);
        }
    }
    let part = symmetric_times(fluid_renormalisation[row].xyz, fluid_renormalisation_between[row].xyz, own) + mirrored;
    let sum = share_sum3(lane, part);
    if (share.writes) {
        let before = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(before, before.xyz + sum);
    }
}
