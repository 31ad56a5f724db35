// #include body, surface, wrench, fluid_wrench, cohesion_share
// Surface tension at walls and bodies; `adhesion.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_adhesion: array<f32>;
@group(0) @binding(4) var<storage, read> body_states: array<Body>;
@group(0) @binding(5) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;
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
    var pull = 0.0;
    var sum = vec3<f32>(0.0);
    if (is_row) {
        point = fluid_position[row].xyz;
        pull = params.cohesion_stiffness * (params.cohesion_volume / params.particle_mass) * fluid_adhesion[row];
        sum = pull * cohesion_share_of_walls(point).xyz;
    }
    for (var index = 0u; index < params.body_rows; index += 1u) {
        let body = body_states[index];
        let own = pull * cohesion_share_of_body(body, point).xyz;
        sum += own;
        let impulse = own * (-clock.step * params.particle_mass);
        let touches = is_row && any(own != vec3<f32>(0.0));
        add_wrench(lane, group_of(group, groups), index, touches, point - body.position, impulse);
    }
    if (is_row) {
        let own = fluid_acceleration[row];
        fluid_acceleration[row] = with_vector(own, own.xyz + sum);
    }
}
