// #include smoothing, images, image
// Mean velocity of the neighbours and images along the lines to them; `approach.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> image_position: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_near_images: array<u32>;
@group(0) @binding(7) var<storage, read> fluid_image_vectors: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_approach: array<vec4<f32>>;

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
    let rows = params.fluid_rows;
    let point = fluid_position[row].xyz;
    let own = fluid_velocity[row].xyz;
    var sum = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    var slot = row;
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_neighbors[slot];
        let apart = apart_from(point, fluid_position[other].xyz);
        sum += (pair_factor(apart) * dot(fluid_velocity[other].xyz - own, apart)) * apart;
    }
    let seen = fluid_near_images[row];
    slot = row;
    for (var k = 0u; k < seen; k += 1u) {
        slot += rows;
        let other = fluid_near_images[slot];
        let there = image_position[other];
        let apart = apart_from(point, there.xyz);
        sum += (there.w * pair_factor(apart) * dot(fluid_image_vectors[other].xyz - own, apart)) * apart;
    }
    fluid_approach[row] = vec4<f32>(sum / params.lattice_moment, 0.0);
}
