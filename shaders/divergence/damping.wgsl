// #include smoothing, images, image, damping, shares
// Damping of velocities that differ from particle to particle; `damping.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_approach: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(7) var<storage, read> fluid_image_vectors: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_pressure_solve: Solve;
@group(0) @binding(9) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

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
    let own = fluid_approach[row].xyz;
    var sum = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        sum += (pair_factor(apart) * dot(fluid_approach[other].xyz - own, apart)) * apart;
    }
    let seen = fluid_near_images[row];
    for (var k = share.first; k < seen; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let there = image_position[other];
        let apart = apart_from(point, there.xyz);
        sum += (there[IMAGE_RATIO] * pair_factor(apart) * dot(fluid_image_vectors[other].xyz - own, apart)) * apart;
    }
    let all = share_sum3(lane, sum);
    if (share.writes) {
        let before = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(before, before.xyz - all * damping_rate());
    }
}
