// #include wrench, body_motion
// Velocities of the bodies by the pressure of the present round.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> body_states: array<Body>;
@group(0) @binding(3) var<storage, read> wrenches: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> body_expected: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> body_expected_spin: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> body_solved: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> body_solved_spin: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    let row = group.x;
    if (clock.running == 0u || row >= params.body_rows) {
        return;
    }
    let received = total_wrench(row, lane);
    if (lane == 0u) {
        let body = body_states[row];
        let change = body.inverse_mass * received.impulse;
        body_solved[row] = vec4<f32>(body_expected[row].xyz + change, 0.0);
        body_solved_spin[row] = vec4<f32>(body_expected_spin[row].xyz + turned_by(body, received.angular), 0.0);
    }
}
