// #include smoothing, shares
// Pressure of the particles against the material of the sponge, at the beginning of the step.
//
//     a_i -= P_i grad lambda_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_solid: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(6) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    let own = fluid_position[row];
    let end = fluid_controls[row];
    var sum = vec3<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let apart = own.xyz - control_position[other].xyz;
        let u = closeness(params.solid, dot(apart, apart));
        sum += (control_solid[other][CONTROL_SOLID_VOLUME] * (u * u * u)) * apart;
    }
    let all = share_sum3(lane, sum);
    if (share.writes) {
        let before = fluid_acceleration[row];
        let scale = params.solid.gradient * params.rest_density * own[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY];
        fluid_acceleration[row] = with_vector(before, before.xyz + all * scale);
    }
}
