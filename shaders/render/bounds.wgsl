// #include numbers, scene
// The box around all particles, and every so many of them.

@group(0) @binding(1) var<storage, read> positions: array<vec4<f32>>;
// Lowest and highest corner, as numbers that grow as floats do.
@group(0) @binding(2) var<storage, read_write> bounds: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> sampled: array<vec4<f32>>;

var<workgroup> group_bounds: array<atomic<u32>, 6>;

@compute @workgroup_size(GROUP)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32) {
    if (lane < 6u) {
        atomicStore(&group_bounds[lane], select(0u, 0xffffffffu, lane < 3u));
    }
    workgroupBarrier();
    let row = row_of(group, groups, lane);
    if (row < scene.particles) {
        let place = positions[row].xyz;
        if (all_finite(place)) {
            for (var axis = 0u; axis < 3u; axis++) {
                atomicMin(&group_bounds[axis], ordered(place[axis]));
                atomicMax(&group_bounds[axis + 3u], ordered(place[axis]));
            }
        }
        if (row % scene.sample_pace == 0u) {
            sampled[row / scene.sample_pace] = vec4(place, select(0.0, 1.0, all_finite(place)));
        }
    }
    workgroupBarrier();
    if (lane < 3u) {
        atomicMin(&bounds[lane], atomicLoad(&group_bounds[lane]));
    } else if (lane < 6u) {
        atomicMax(&bounds[lane], atomicLoad(&group_bounds[lane]));
    }
}
