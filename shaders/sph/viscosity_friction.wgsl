// #include body, surface, friction
// Before the solve for the implicit viscosity: the friction of walls and bodies, its part of the residual, and zero change.
//
//     F_i = sum_s f(y) (1 - n n^T),   r_i = -h (F_i v_i - sum_s f(y) (1 - n n^T) v_s)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> body_states: array<Body>;
@group(0) @binding(5) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_friction: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_friction_between: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_viscosity_residual: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_viscosity_change: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let point = fluid_position[row].xyz;
    let v = fluid_velocity[row].xyz;
    var axes = vec3<f32>(0.0);
    var between = vec3<f32>(0.0);
    if (params.has_walls != 0u && params.no_slip > 0u) {
        var rates = vec3<f32>(0.0);
        for (var axis = 0u; axis < 3u; axis += 1u) {
            rates[axis] = friction_rate(point[axis] - params.wall_low[axis])
                + friction_rate(params.wall_high[axis] - point[axis]);
        }
        axes = vec3<f32>(rates.y + rates.z, rates.x + rates.z, rates.x + rates.y);
    }
    var slowed = axes * v;
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        if (body.no_slip != 0u) {
            let surface = body_surface(body, point);
            let rate = friction_rate(surface.distance);
            let n = surface.normal;
            axes += rate * (vec3<f32>(1.0) - n * n);
            between -= rate * (n.yzx * n.zxy);
            let slide = v - body_velocity(body, point);
            slowed += rate * (slide - n * dot(slide, n));
        }
    }
    fluid_friction[row] = vec4<f32>(axes, 0.0);
    fluid_friction_between[row] = vec4<f32>(between, 0.0);
    fluid_viscosity_residual[row] = vec4<f32>(-clock.step * slowed, 0.0);
    fluid_viscosity_change[row] = vec4<f32>(0.0);
}
