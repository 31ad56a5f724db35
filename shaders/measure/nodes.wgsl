// #include sums, partial_sums
// Sums of the measures over the nodes, per workgroup.
//
// a: momentum, twice the kinetic energy; b: angular momentum, mass; c: sum of mass times position, of volume times
// saturation; d: volume; largest: squared speed, height of nodes more than half saturated, depth of the lowest node.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(2) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> node_mass: array<f32>;
@group(0) @binding(4) var<storage, read> node_volume: array<f32>;
@group(0) @binding(5) var<storage, read> node_saturation: array<f32>;
@group(0) @binding(6) var<storage, read_write> partial_sums: array<GroupSums>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    var own = no_sums();
    if (row < params.node_rows) {
        let x = node_position[row].xyz;
        let v = node_velocity[row].xyz;
        let mass = node_mass[row];
        let square = dot(v, v);
        own.a = mass * vec4<f32>(v, square);
        own.b = mass * vec4<f32>(cross(x, v), 1.0);
        own.c = vec4<f32>(mass * x, 0.0);
        var wet = NO_VALUE;
        if (params.fluid_rows > 0u) {
            let saturation = node_saturation[row];
            own.c.w = saturation * node_volume[row];
            own.d.x = node_volume[row];
            if (saturation > WET) {
                wet = x.y;
            }
        }
        own.largest = vec4<f32>(square, wet, -x.y, NO_VALUE);
    }
    write_sums(group_of(group, groups), lane, group_sums(lane, own));
}
