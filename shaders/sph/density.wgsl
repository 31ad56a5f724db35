// #include smoothing, images
// Mass density by summation over existing lists.
//
//     rho_i = sum_j m W(|x_i - x_j|)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read_write> fluid_density: array<f32>;

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
    let end = fluid_neighbors[row];
    var slot = row;
    var sum = 0.0;
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let apart = apart_from(point, fluid_position[fluid_neighbors[slot]].xyz);
        sum += shape(closeness(params.smoothing, dot(apart, apart)));
    }
    fluid_density[row] = sum * (params.smoothing.value * params.particle_mass);
}
