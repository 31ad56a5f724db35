// #include sums, partial_sums
// Sums of the measures over the particles, per workgroup.
//
// a: momentum, twice the kinetic energy, b: angular momentum, number inside of sponges, all for a mass of one;
// c: sum of the positions, sum of density errors; largest: squared speed, density error.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> fluid_position_next: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> fluid_velocity_next: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_density: array<f32>;
@group(0) @binding(4) var<storage, read> fluid_interior: array<f32>;
@group(0) @binding(5) var<storage, read_write> partial_sums: array<GroupSums>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    var own = no_sums();
    if (row < params.fluid_rows) {
        let x = fluid_position_next[row].xyz;
        let v = fluid_velocity_next[row].xyz;
        let square = dot(v, v);
        var inside = 0.0;
        // Without nodes there is nothing to be inside of, and the column has no rows.
        if (params.node_rows > 0u && fluid_interior[row] > INSIDE) {
            inside = 1.0;
        }
        let error = max((fluid_density[row] - params.rest_density) / params.rest_density, 0.0);
        own.a = vec4<f32>(v, square);
        own.b = vec4<f32>(cross(x, v), inside);
        own.c = vec4<f32>(x, error);
        own.largest = vec4<f32>(square, error, NO_VALUE, NO_VALUE);
    }
    write_sums(group_of(group, groups), lane, group_sums(lane, own));
}
