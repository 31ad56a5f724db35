// #include smoothing, drag, shares
// First pass of `couple::solid_moments`: how much the drag leaves of a change of the velocity, and the mass that moves with the nodes.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_mobility: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_held: array<vec4<f32>>;

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
    let point = fluid_position[row].xyz;
    let end = fluid_controls[row];
    var sum = vec3<f32>(0.0);
    var interior = 0.0;
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        sum += weight * control_material[other].xyz;
        interior += weight;
    }
    let all = share_sum(lane, vec4<f32>(sum, interior));
    if (!share.writes) {
        return;
    }
    let inverse = weight_inside(all.w);
    let relative = fluid_velocity[row].xyz - all.xyz * inverse;
    let drag = fluid_drag_rate[row].xy;
    let rate = select(0.0, (drag.x + drag.y * length(relative)) * clock.step, inverse > 0.0);
    let mobility = 1.0 / (1.0 + rate);
    fluid_mobility[row] = vec4<f32>(mobility, 0.0, 0.0, 0.0);
    fluid_held[row] = vec4<f32>(0.0, 0.0, 0.0, rate * mobility * params.particle_mass * inverse);
}
