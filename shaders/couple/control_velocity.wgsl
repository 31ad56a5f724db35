// Second pass of `couple::control_velocity`: how many particles share a node, over its mass.
//
//     s_a = sum_i w_ia / m_a,   w_ia = V_a W_ia / chi_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> interior: array<f32>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> list: array<u32>;
@group(0) @binding(6) var<storage, read> unfiltered: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> control_velocity: array<vec4<f32>>;

@compute @workgroup_size(256)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.node_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let own = control_position[row];
    let scale = own.w * params.coupling.value;
    let end = list[row];
    var slot = row;
    var sum = 0.0;
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = list[slot];
        let apart = own.xyz - position[other].xyz;
        sum += scale * shape(closeness(params.coupling, dot(apart, apart))) * weight_inside(interior[other]);
    }
    let before = unfiltered[row];
    control_velocity[row] = vec4<f32>(before.xyz, sum * before.w);
}
