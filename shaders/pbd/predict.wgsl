// #include body
// Initial position change: y = x + h (v + h a). Held nodes follow their body.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_acceleration: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_grip: array<u32>;
@group(0) @binding(6) var<storage, read> node_grip_offset: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> body_states: array<Body>;
@group(0) @binding(8) var<storage, read_write> node_predicted: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> body_node_wrenches: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let x = node_position[row];
    var y = x.xyz + clock.step * (node_velocity[row].xyz + clock.step * node_acceleration[row].xyz);
    let holder = node_grip[row];
    if (holder < params.body_rows) {
        let body = body_states[holder];
        let offset = node_grip_offset[row].xyz;
        let arm = body.x * offset.x + body.y * offset.y + body.z * offset.z;
        y = body.position + arm + (body.linear + cross(body.angular, arm)) * clock.step;
    }
    node_predicted[row] = with_vector(x, y);
    if (lane == 0u) {
        let first = group_of(group, groups) * params.body_rows * WRENCH_ROWS;
        for (var k = 0u; k < params.body_rows * WRENCH_ROWS; k += 1u) {
            body_node_wrenches[first + k] = vec4<f32>(0.0);
        }
    }
}
