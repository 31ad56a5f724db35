// #include wrench, smoothing, image
// What particles receive through their images in bodies. Those receive the rest of what the images do.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> points: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_image_first: array<u32>;
@group(0) @binding(4) var<storage, read> images: array<Image>;
@group(0) @binding(5) var<storage, read> image_forces: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> body_states: array<Body>;
@group(0) @binding(7) var<storage, read_write> vectors: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> wrenches: array<vec4<f32>>;

fn react(group: vec3<u32>, groups: vec3<u32>, lane: u32, factor: f32) {
    let row = row_of(group, groups, lane);
    let is_row = row < params.fluid_rows;
    var point = vec3<f32>(0.0);
    var begin = 0u;
    var end = 0u;
    if (is_row) {
        point = points[row].xyz;
        begin = fluid_image_first[row];
        end = fluid_image_first[row + 1u];
    }
    var sum = vec3<f32>(0.0);
    let scale = params.particle_mass * clock.step;
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let centre = body_states[index].position;
        var own = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
        for (var k = begin; k < end; k += 1u) {
            let image = images[k];
            if (image.body == index) {
                let force = image_forces[k].xyz;
                let given = back(image, force);
                let kept = signs_of(image) * force;
                sum += given;
                own.impulse += scale * (kept - given);
                own.angular += scale * (cross(image.foot - centre, kept) - cross(point - centre, given));
            }
        }
        let place = group_of(group, groups);
        let slot = (place * params.body_rows + index) * WRENCH_ROWS;
        var all = Wrench(vec3<f32>(0.0), vec3<f32>(0.0));
        if (group_touches(lane, any(own.impulse != vec3<f32>(0.0)))) {
            all = group_sum(lane, own);
        }
        if (lane == 0u && place * GROUP_THREADS < params.fluid_rows) {
            wrenches[slot] = vec4<f32>(all.impulse, 0.0);
            wrenches[slot + 1u] = vec4<f32>(all.angular, 0.0);
        }
    }
    if (is_row) {
        let before = vectors[row];
        vectors[row] = with_vector(before, before.xyz + factor * sum);
    }
}

// Added to accelerations.
@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    react(group, groups, lane, 1.0);
}

// Added to velocities.
@compute @workgroup_size(GROUP_THREADS)
fn push(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    react(group, groups, lane, clock.step);
}
