// #include smoothing, images, image, shares
// Rate at which neighbours come closer: the opposite of the renormalised divergence, particles alone. `rate_images.wgsl` adds the images.
//
//     -div v_i = sum_j c_ij (v_j - v_i) . L_i x_ij

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_rate: array<f32>;

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
    let moved = fluid_correction[row];
    let own = moved.xyz;
    var on = vec3<f32>(0.0);
    var off = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let offset = apart_from(point, fluid_position[other].xyz);
        let apart = pair_factor(offset) * offset;
        let v = fluid_correction[other].xyz - own;
        on += v * apart;
        off += v.yzx * apart.zxy + v.zxy * apart.yzx;
    }
    let along = fluid_renormalisation[row].xyz;
    let between = fluid_renormalisation_between[row].xyz;
    let rate = share_sum(lane, vec4<f32>(dot(on, along) + dot(off, between), 0.0, 0.0, 0.0)).x;
    if (share.writes) {
        // Beside the velocity is the part of the material of sponges.
        fluid_rate[row] = rate + moved[FLUID_CORRECTION_COMPRESSION_RATE];
    }
}
