// #include smoothing, images
// Surface tension: force on the particles by a surface energy.
//
//     E = k sum_i V f(e_i),   a_i = k V^2 / m sum_j (w_i / phi_i + w_j / phi_j) grad W_ij   with w = f'

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_deficit: array<f32>;
@group(0) @binding(5) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

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
    let weight = fluid_deficit[row];
    let end = fluid_neighbors[row];
    var slot = row;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_neighbors[slot];
        let apart = apart_from(point, fluid_position[other].xyz);
        let u = closeness(params.cohesion, dot(apart, apart));
        sum += apart * (u * u * u * (weight + fluid_deficit[other]));
    }
    let volume = params.cohesion_volume;
    let factor = params.cohesion_stiffness * volume * (volume / params.particle_mass);
    let own = fluid_acceleration[row];
    fluid_acceleration[row] = with_vector(own, own.xyz - sum * (params.cohesion.gradient * factor));
}
