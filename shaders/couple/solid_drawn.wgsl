// #include smoothing, control_group
// Second pass of `couple::solid_moments`: the mass of the water that the drag moves with every node.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_held: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(6) var<storage, read_write> control_compliance: array<vec4<f32>>;

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
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    let scale = own[CONTROL_POSITION_VOLUME] * params.coupling.value;
    var part = 0.0;
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let apart = own.xyz - fluid_position[other].xyz;
        part += scale * shape(closeness(params.coupling, dot(apart, apart))) * fluid_held[other][FLUID_HELD_MASS];
    }
    let sum = control_sum(lane, vec4<f32>(part, 0.0, 0.0, 0.0));
    if (is_row && lane % CONTROL_THREADS == 0u) {
        control_compliance[row] = sum;
    }
}
