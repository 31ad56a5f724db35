// #include smoothing, images, sum_of_shapes
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
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    fluid_density[row] = sum_of_shapes(params.smoothing, row) * (params.smoothing.value * params.particle_mass);
}
