// #include smoothing, images, image
// Second pass of `divergence::moments`: the diagonal of the system, to which images of a particle add what they give back to it.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_image_first: array<u32>;
@group(0) @binding(4) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> images: array<Image>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_pressure_rows: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let point = fluid_position[row].xyz;
    let along = fluid_renormalisation[row].xyz;
    let between = fluid_renormalisation_between[row];
    var push = fluid_factors[row].xyz;
    var own = 0.0;
    let end = fluid_image_first[row + 1u];
    for (var k = fluid_image_first[row]; k < end; k += 1u) {
        let there = image_position[k];
        let offset = -apart_from(point, there.xyz);
        let received = (there[IMAGE_RATIO] * pair_factor(offset)) * symmetric_times(along, between.xyz, offset);
        push += back(images[k], received);
        own += dot(received, received);
    }
    let minimum = MINIMUM_DIAGONAL / (params.spacing * params.spacing);
    let diagonal = max(max(between[BEFORE_IMAGES] - own, 0.0) + dot(push, push), minimum);
    fluid_renormalisation_between[row] = vec4<f32>(between.xyz, 0.0);
    fluid_pressure_rows[row] = vec4<f32>(0.0, 0.0, diagonal * (clock.step * clock.step), 0.0);
}
