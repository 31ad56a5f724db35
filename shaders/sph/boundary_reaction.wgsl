// #include body, surface, wrench, fluid_wrench, profile
// Reaction of bodies to the change of the pressure, at their places of the end of the step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> body_states: array<Body>;
@group(0) @binding(4) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

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
    if (is_row) {
        own = fluid_predicted[row];
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = at_end(body_states[index]);
        let push = own[FLUID_PREDICTED_PRESSURE_CHANGE] * body_share(body, own.xyz).xyz;
        let impulse = push * (clock.step * params.particle_mass);
        let touches = is_row && any(push != vec3<f32>(0.0));
        add_wrench(lane, group_of(group, groups), index, touches, own.xyz - body.position, impulse);
    }
}
