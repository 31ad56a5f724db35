// #include smoothing, drag, control_group
// Second pass of `couple::control_velocity`: number of particles that share a node, over its mass.
//
//     s_a = sum_i w_ia / m_a,   w_ia = V_a W_ia / chi_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(6) var<storage, read> control_unfiltered: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> control_velocity: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let own = control_position[min(row, params.node_rows - 1u)];
    let scale = own[CONTROL_POSITION_VOLUME] * params.coupling.value;
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = 0.0;
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_position[other].xyz;
        let inverse = weight_inside(fluid_drag_rate[other][FLUID_DRAG_RATE_NODE_WEIGHT]);
        part += scale * shape(closeness(params.coupling, dot(apart, apart))) * inverse;
    }
    let sum = control_sum(lane, vec4<f32>(part, 0.0, 0.0, 0.0)).x;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let before = control_unfiltered[row];
    control_velocity[row] = vec4<f32>(before.xyz, sum * before[CONTROL_UNFILTERED_INVERSE_MASS]);
}
