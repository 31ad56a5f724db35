// #include smoothing
// Compliance of the material of the sponge to the pressure change of a solve; `solid_yield.rs` has the reason.
//
//     y_i = 2 f_i sum_j c_ij f_j (dP_j - dP_i)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_solid_yield: array<f32>;

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
    let own = fluid_predicted[row];
    let follows = fluid_drag_rate[row].z;
    var sum = 0.0;
    if (follows > 0.0) {
        let gradient = params.smoothing.gradient * (params.particle_mass / params.rest_density);
        let end = fluid_neighbors[row];
        var slot = row;
        for (var k = 0u; k < end; k += 1u) {
            slot += rows;
            let other = fluid_neighbors[slot];
            let there = fluid_predicted[other];
            let apart = own.xyz - there.xyz;
            let u = closeness(params.smoothing, dot(apart, apart));
            sum += gradient * (u * u * u) * fluid_drag_rate[other].z * (there.w - own.w);
        }
    }
    fluid_solid_yield[row] = 2.0 * follows * sum;
}
