// #include smoothing, images, image, shares
// The part of the images in the rate of `rate.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(5) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_image_vectors: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_rate: array<f32>;

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
    let own = fluid_correction[row].xyz;
    var on = vec3<f32>(0.0);
    var off = vec3<f32>(0.0);
    let end = fluid_near_images[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let there = image_position[other];
        let offset = apart_from(point, there.xyz);
        let apart = (there[IMAGE_RATIO] * pair_factor(offset)) * offset;
        let v = fluid_image_vectors[other].xyz - own;
        on += v * apart;
        off += v.yzx * apart.zxy + v.zxy * apart.yzx;
    }
    let along = fluid_renormalisation[row].xyz;
    let between = fluid_renormalisation_between[row].xyz;
    let rate = share_sum(lane, vec4<f32>(dot(on, along) + dot(off, between), 0.0, 0.0, 0.0)).x;
    if (share.writes) {
        fluid_rate[row] += rate;
    }
}
