// #include sponges
// Adds to every node its part of the rigid motion that restores the momentum of its sponge. Stores the share of the external acceleration
// that it followed.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<uniform> sponges: Sponges;
@group(0) @binding(3) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> node_acceleration: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> node_sponge: array<u32>;
@group(0) @binding(6) var<storage, read> node_reaction: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> sponge_motions: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> node_predicted: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_velocity: array<vec4<f32>>;

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
    let sponge = node_sponge[row];
    let start = node_predicted[row];
    if (start[NODE_PREDICTED_INVERSE_MASS] <= 0.0 || sponges.all[sponge].solver != SOLVER_VBD) {
        return;
    }
    let x = node_position[row].xyz;
    var y = start.xyz;
    if (node_reaction[row][NODE_REACTION_MASS] > 0.0) {
        let turn = cross(sponge_motions[sponge * MOTION_ROWS + 2u].xyz, x - sponge_motions[sponge * MOTION_ROWS].xyz);
        y += (sponge_motions[sponge * MOTION_ROWS + 1u].xyz + turn) * clock.step;
        if (params.has_walls != 0u) {
            // What is not a number stays so.
            y = select(y, params.wall_low, y < params.wall_low);
            y = select(y, params.wall_high, y > params.wall_high);
        }
    }
    node_predicted[row] = with_vector(start, y);
    let v = node_velocity[row].xyz;
    let a = node_acceleration[row].xyz;
    let square = dot(a, a);
    var share = 0.0;
    if (square > 0.0) {
        share = clamp(dot((y - x) / clock.step - v, a) / (clock.step * square), 0.0, 1.0);
    }
    node_velocity[row] = vec4<f32>(v, share);
}
