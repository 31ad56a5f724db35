// #include sums, water_around
// The water around points: a group for each.
//
// a: shares of the space, of particles and of these with their images behind walls, sum of share times the fourth lane of the velocity;
// b: sum of share times velocity. The same order of sums for the same rows.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> question: Question;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> asked: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> answers: array<QueryAnswer>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let index = group_of(group, groups);
    let point = asked[min(index, question.count - 1u)].xyz;
    var shares = vec4<f32>(0.0);
    var motion = vec4<f32>(0.0);
    for (var row = lane; row < params.fluid_rows; row += GROUP_THREADS) {
        let share = shares_around(point, fluid_position[row].xyz);
        if (share.y > 0.0) {
            let velocity = fluid_velocity[row];
            shares += vec4<f32>(share, share.x * velocity.w, 0.0);
            motion += vec4<f32>(share.x * velocity.xyz, 0.0);
        }
    }
    let all_shares = group_row(lane, shares, false);
    let all_motion = group_row(lane, motion, false);
    if (lane == 0u && index < question.count) {
        answers[index] = QueryAnswer(all_shares, all_motion);
    }
}
