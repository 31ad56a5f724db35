// #include body, surface, profile
// Boundary volume fraction of walls and bodies around a particle, at the end of the step.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> body_states: array<Body>;
@group(0) @binding(3) var<storage, read> planes: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_boundary: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let point = fluid_predicted[row].xyz;
    var sum = wall_share(point);
    for (var index = 0u; index < params.body_rows; index += 1u) {
        sum += body_share(at_end(body_states[index]), point);
    }
    fluid_boundary[row] = sum;
}
