// #include body, surface, wrench, fluid_wrench
// What holds films and drops on walls and bodies; `retention.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_density: array<f32>;
@group(0) @binding(4) var<storage, read> fluid_moment: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> body_states: array<Body>;
@group(0) @binding(6) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> body_fluid_wrenches: array<vec4<f32>>;

// The part of a velocity along a surface that is taken.
fn taken(distance: f32, slide: vec3<f32>, most: f32) -> vec3<f32> {
    if (distance >= params.retention_range) {
        return vec3<f32>(0.0);
    }
    return slide * (most / max(sqrt(dot(slide, slide)), most));
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
    var most = 0.0;
    if (is_row && fluid_moment[row][FLUID_MOMENT_MATERIAL] <= MINIMUM_MATERIAL) {
        point = fluid_position[row].xyz;
        v = fluid_velocity[row].xyz;
        let lack = params.retention_density - fluid_density[row];
        most = clock.step * params.retention_strength * max(lack, 0.0);
    }
    if (most > 0.0 && params.has_walls != 0u) {
        for (var axis = 0u; axis < 3u; axis += 1u) {
            var low = v;
            low[axis] = 0.0;
            v -= taken(point[axis] - params.wall_low[axis], low, most);
            var high = v;
            high[axis] = 0.0;
            v -= taken(params.wall_high[axis] - point[axis], high, most);
        }
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        var slowed = vec3<f32>(0.0);
        if (most > 0.0) {
            let surface = body_surface(body, point);
            slowed = taken(surface.distance, slide_along(body, surface, point, v), most);
        }
        v -= slowed;
        let impulse = slowed * params.particle_mass;
        let touches = any(slowed != vec3<f32>(0.0));
        add_wrench(lane, group_of(group, groups), index, touches, point - body.position, impulse);
    }
    if (most > 0.0) {
        fluid_velocity[row] = with_vector(fluid_velocity[row], v);
    }
}
