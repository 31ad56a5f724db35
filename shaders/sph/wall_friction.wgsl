// #include body, surface, wrench, fluid_wrench, friction
// Friction of the fluid at no-slip walls and bodies.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> body_states: array<Body>;
@group(0) @binding(5) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

fn bounded_rate(distance: f32) -> f32 {
    return min(friction_rate(distance), clock.inverse_step);
}

fn wall_friction(point: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    if (params.has_walls == 0u || params.no_slip == 0u) {
        return vec3<f32>(0.0);
    }
    var rates = vec3<f32>(0.0);
    for (var axis = 0u; axis < 3u; axis += 1u) {
        rates[axis] = bounded_rate(point[axis] - params.wall_low[axis])
            + bounded_rate(params.wall_high[axis] - point[axis]);
    }
    return v * vec3<f32>(rates.y + rates.z, rates.x + rates.z, rates.x + rates.y);
}

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
    var sum = vec3<f32>(0.0);
    if (is_row) {
        point = fluid_position[row].xyz;
        v = fluid_velocity[row].xyz;
        sum = wall_friction(point, v);
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        var slowed = vec3<f32>(0.0);
        if (is_row && body.no_slip != 0u) {
            let surface = body_surface(body, point);
            slowed = slide_along(body, surface, point, v) * bounded_rate(surface.distance);
        }
        sum += slowed;
        let impulse = slowed * (clock.step * params.particle_mass);
        let touches = any(slowed != vec3<f32>(0.0));
        add_wrench(lane, group_of(group, groups), index, touches, point - body.position, impulse);
    }
    if (is_row) {
        let own = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(own, own.xyz - sum);
    }
}
