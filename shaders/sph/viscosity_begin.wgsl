// #include smoothing, images, viscosity
// Before the first round of a solve for the implicit viscosity: what pairs add to the residual, and the first direction.
//
//     r_i = p_i = -h D_i(v*)
//
// What `sph::viscosity_strain` left in the place of the product is part of D.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_viscosity_residual: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_viscosity_direction: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_viscosity_solve: ViscositySolve;
@group(0) @binding(8) var<storage, read> fluid_viscosity_product: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let point = fluid_position[row].xyz;
    let own = fluid_velocity[row];
    let end = select(0u, fluid_neighbors[row], has_viscous_pairs());
    var slot = row;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_neighbors[slot];
        let there = fluid_velocity[other];
        sum += viscosity_pair(apart_from(point, fluid_position[other].xyz), own.xyz - there.xyz);
    }
    if (params.strain_viscosity > 0.0) {
        sum += fluid_viscosity_product[row].xyz;
    }
    let residual = fluid_viscosity_residual[row].xyz - clock.step * sum;
    fluid_viscosity_residual[row] = vec4<f32>(residual, 0.0);
    fluid_viscosity_direction[row] = vec4<f32>(residual, 0.0);
    if (row == 0u) {
        fluid_viscosity_solve = ViscositySolve();
    }
}
