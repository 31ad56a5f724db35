// #include body, surface, wrench, fluid_wrench, profile
// Pressure of the particles against walls and bodies, at the beginning of the step.
//
//     a_i -= P_i grad lambda_i,   impulse of a body = m h sum_i P_i grad lambda_ik
//
// One wrench per body and group of 256 particles, summed by `body_wrenches.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_states: array<Body>;
@group(0) @binding(4) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    let is_row = row < rows;
    var own = vec4<f32>(0.0);
    var sum = vec3<f32>(0.0);
    var pressure = 0.0;
    if (is_row) {
        own = fluid_position[row];
        pressure = own[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY] * params.rest_density;
        sum = fluid_acceleration[row].xyz - pressure * wall_share(own.xyz).xyz;
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        let gradient = body_share(body, own.xyz).xyz;
        let push = pressure * gradient;
        sum -= push;
        let impulse = push * (clock.step * params.particle_mass);
        let touches = is_row && any(push != vec3<f32>(0.0));
        begin_wrench(lane, group_of(group, groups), index, touches, own.xyz - body.position, impulse);
    }
    if (is_row) {
        fluid_acceleration[row] = with_vector(fluid_acceleration[row], sum);
    }
}
