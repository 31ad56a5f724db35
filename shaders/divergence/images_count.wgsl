// #include body, surface, mirror, visit_images
// First pass of `divergence::images`: the number of images of every particle, and of those of a page of particles. Moments
// begin at zero.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_states: array<Body>;
@group(0) @binding(4) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> image_line_counts: array<u32>;
@group(0) @binding(6) var<storage, read_write> image_line_sums: array<atomic<u32>>;
@group(0) @binding(7) var<storage, read_write> fluid_moment: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_renormalisation_between: array<vec4<f32>>;

fn take_image(k: u32, position: vec3<f32>, base: Mirrored, body: u32, walls: u32) {}

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
    let count = visit_images(fluid_position[row].xyz);
    image_line_counts[row] = count;
    atomicAdd(&image_line_sums[row / PAGE_CELLS], count);
    fluid_moment[row] = vec4<f32>(0.0);
    fluid_renormalisation[row] = vec4<f32>(0.0);
    fluid_renormalisation_between[row] = vec4<f32>(0.0);
}
