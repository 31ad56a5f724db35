// #include body, surface, wrench, fluid_wrench, friction
// Reaction of no-slip bodies, where viscosity is implicit.
//
//     impulse = m h sum_i f(y) (v*_i + y_i - v_body)_t

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_viscosity_change: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> body_states: array<Body>;
@group(0) @binding(6) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

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
    let is_row = row < params.fluid_rows;
    var point = vec3<f32>(0.0);
    var v = vec3<f32>(0.0);
    if (is_row) {
        point = fluid_position[row].xyz;
        v = fluid_velocity[row].xyz + fluid_viscosity_change[row].xyz;
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        var slowed = vec3<f32>(0.0);
        if (is_row && body.no_slip != 0u) {
            let surface = body_surface(body, point);
            slowed = slide_along(body, surface, point, v) * friction_rate(surface.distance);
        }
        let impulse = slowed * (clock.step * params.particle_mass);
        let touches = any(slowed != vec3<f32>(0.0));
        add_wrench(lane, group_of(group, groups), index, touches, point - body.position, impulse);
    }
}
