// #include smoothing, shares
// Solid volume fraction around a particle, at the expected positions at the end of the step.
//
//     lambda_i += sum_a V_s W(x*_i - x*_a)

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> control_solid: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_boundary: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let rows = params.fluid_rows;
    let share = shared_row(group, groups, lane, rows);
    let row = share.row;
    let point = fluid_predicted[row].xyz;
    let end = fluid_controls[row];
    var part = vec4<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let solid = control_solid[fluid_controls[row + (k + 1u) * rows]];
        let apart = point - solid.xyz;
        let u = closeness(params.solid, dot(apart, apart));
        part += solid[CONTROL_SOLID_VOLUME] * vec4<f32>(apart * (u * u * u), shape(u));
    }
    let sum = share_sum(lane, part);
    if (!share.writes) {
        return;
    }
    let before = fluid_boundary[row];
    let slope = sum.xyz * params.solid.gradient;
    fluid_boundary[row] = vec4<f32>(before.xyz - slope, before[FLUID_BOUNDARY_SHARE] + sum.w * params.solid.value);
}
