// #include smoothing, images, viscosity, sums
// Iteration of the implicit viscosity: the product of its matrix with the direction, and the sums for
// `viscosity_length.wgsl`.
//
//     q_i = p_i + h (D_i(p) + F_i p_i)
//
// What `sph::viscosity_strain` left in the place of q is part of D.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_viscosity_direction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read> fluid_friction: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_friction_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_viscosity_residual: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_viscosity_product: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> viscosity_sums: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
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
    var sums = vec4<f32>(0.0);
    if (row < rows) {
        let point = fluid_position[row].xyz;
        let own = fluid_viscosity_direction[row];
        let end = select(0u, fluid_neighbors[row], has_viscous_pairs());
        var slot = row;
        var sum = vec3<f32>(0.0);
        for (var k = 0u; k < end; k += 1u) {
            slot += rows;
            let other = fluid_neighbors[slot];
            let there = fluid_viscosity_direction[other];
            sum += viscosity_pair(apart_from(point, fluid_position[other].xyz), own.xyz - there.xyz);
        }
        let p = own.xyz;
        let between = fluid_friction_between[row].xyz;
        let slowed = fluid_friction[row].xyz * p + between.yzx * p.zxy + between.zxy * p.yzx;
        if (params.strain_viscosity > 0.0) {
            sum += fluid_viscosity_product[row].xyz;
        }
        let q = p + clock.step * (sum + slowed);
        let r = fluid_viscosity_residual[row].xyz;
        fluid_viscosity_product[row] = vec4<f32>(q, 0.0);
        sums = vec4<f32>(dot(p, q), dot(r, p), dot(r, q), dot(q, q));
    }
    let all = group_row(lane, sums, false);
    let place = group_of(group, groups);
    if (lane == 0u && place * GROUP < rows) {
        viscosity_sums[place] = all;
    }
}
