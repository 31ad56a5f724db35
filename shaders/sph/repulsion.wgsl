// #include body, surface, wrench, fluid_wrench
// Elastic repulsion of particles from walls and bodies.
//
//     a_i += (k (R - d) - c v_n) n   where the distance d from the surface is less than R, not pulling
//
// Bodies receive the opposite: one wrench per body and group of 256 particles, summed by `body_wrenches.wgsl`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> body_states: array<Body>;
@group(0) @binding(5) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

fn push_of(distance: f32, speed: f32) -> f32 {
    let depth = params.repulsion_range - distance;
    if (depth > 0.0) {
        return max(depth * params.repulsion_stiffness - speed * params.repulsion_damping, 0.0);
    }
    return 0.0;
}

fn walls(point: vec3<f32>, speed: vec3<f32>) -> vec3<f32> {
    let low = params.wall_low;
    let high = params.wall_high;
    return vec3<f32>(
        push_of(point.x - low.x, speed.x) - push_of(high.x - point.x, -speed.x),
        push_of(point.y - low.y, speed.y) - push_of(high.y - point.y, -speed.y),
        push_of(point.z - low.z, speed.z) - push_of(high.z - point.z, -speed.z),
    );
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
    var speed = vec3<f32>(0.0);
    var sum = vec3<f32>(0.0);
    if (is_row) {
        point = fluid_position[row].xyz;
        speed = fluid_velocity[row].xyz;
        sum = fluid_acceleration[row].xyz;
        if (params.has_walls != 0u) {
            sum += walls(point, speed);
        }
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        let surface = body_surface(body, point);
        var push = 0.0;
        if (is_row) {
            push = push_of(surface.distance, dot(speed - body_velocity(body, point), surface.normal));
        }
        sum += surface.normal * push;
        let impulse = surface.normal * (-push * (clock.step * params.particle_mass));
        let arm = (point - surface.normal * surface.distance) - body.position;
        begin_wrench(lane, group_of(group, groups), index, push > 0.0, arm, impulse);
    }
    if (is_row) {
        fluid_acceleration[row] = with_vector(fluid_acceleration[row], sum);
    }
}
