// #include wrench, smoothing, images, image, damping
// What bodies receive by the damping, through their images of the particles.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_approach: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(6) var<storage, read> fluid_image_vectors: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_pressure_solve: Solve;
@group(0) @binding(8) var<storage, read> body_states: array<Body>;
@group(0) @binding(9) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    var point = vec3<f32>(0.0);
    var own = vec3<f32>(0.0);
    var end = 0u;
    if (row < rows) {
        point = fluid_position[row].xyz;
        own = fluid_approach[row].xyz;
        end = fluid_near_images[row];
    }
    let scale = params.particle_mass * clock.step * damping_rate();
    for (var index = 0u; index < params.body_rows; index += 1u) {
        var sum = vec3<f32>(0.0);
        var slot = row;
        for (var k = 0u; k < end; k += 1u) {
            slot += rows;
            let other = fluid_near_images[slot];
            let value = fluid_image_vectors[other];
            if (u32(value[IMAGE_BODY]) == index + 1u) {
                let there = image_position[other];
                let apart = apart_from(point, there.xyz);
                sum += (there[IMAGE_RATIO] * pair_factor(apart) * dot(value.xyz - own, apart)) * apart;
            }
        }
        if (group_touches(lane, any(sum != vec3<f32>(0.0)))) {
            let impulse = scale * sum;
            let all = group_sum(lane, Wrench(impulse, cross(point - body_states[index].position, impulse)));
            let slot = (group_of(group, groups) * params.body_rows + index) * WRENCH_ROWS;
            if (lane == 0u && group_of(group, groups) * GROUP_THREADS < rows) {
                body_fluid_wrenches[slot] += vec4<f32>(all.impulse, 0.0);
                body_fluid_wrenches[slot + 1u] += vec4<f32>(all.angular, 0.0);
            }
        }
    }
}
