// #include sponges
// First guess of vertex block descent: z = y, y <- z - h^2 (1 - s) a.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_acceleration: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(6) var<storage, read_write> node_predicted: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> node_free: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> node_target: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_drag: array<vec4<f32>>;
@group(0) @binding(10) var<storage, read_write> node_drag_moment: array<vec4<f32>>;

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
    let y = node_predicted[row];
    var mass = 0.0;
    if (y[NODE_PREDICTED_INVERSE_MASS] > 0.0) {
        mass = 1.0 / y[NODE_PREDICTED_INVERSE_MASS];
    }
    node_free[row] = vec4<f32>(y.xyz, mass);
    node_target[row] = vec4<f32>(y.xyz, mass);
    node_drag[row] = vec4<f32>(0.0);
    node_drag_moment[row] = vec4<f32>(0.0);
    if (y[NODE_PREDICTED_INVERSE_MASS] > 0.0 && sponges.all[node_sponge[row]].solver == SOLVER_VBD) {
        let lacking = clock.step * clock.step * (1.0 - node_velocity[row][NODE_VELOCITY_FOLLOWED_SHARE]);
        node_predicted[row] = with_vector(y, y.xyz - node_acceleration[row].xyz * lacking);
    }
}
