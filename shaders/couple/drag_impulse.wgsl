// #include smoothing, drag, shares
// Drag impulse that every particle loses to the sponge, at the present velocities of the nodes; `drag_impulse.rs` has the
// formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_node: array<u32>;
@group(0) @binding(8) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_drag: array<vec4<f32>>;

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
    var part = vec4<f32>(0.0);
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_controls[row + (k + 1u) * rows];
        let there = control_position[other];
        let apart = point - there.xyz;
        let weight = there[CONTROL_POSITION_VOLUME] * params.coupling.value * shape(closeness(params.coupling, dot(apart, apart)));
        // As `node_velocity.wgsl` has it, which may run beside this.
        let velocity = (node_predicted[control_node[other]].xyz - there.xyz) * clock.inverse_step;
        part += weight * vec4<f32>(velocity, 1.0);
    }
    let sum = share_sum(lane, part);
    if (!share.writes) {
        return;
    }
    if (end == 0u) {
        fluid_drag[row] = vec4<f32>(0.0);
        return;
    }
    let inverse = weight_inside(sum.w);
    let relative = fluid_velocity[row].xyz - sum.xyz * inverse;
    // The column has impulses and masses over chi.
    let strength =
        drag_strength(fluid_drag_rate[row].xy, length(relative), clock.step) * params.particle_mass * inverse;
    fluid_drag[row] = vec4<f32>(relative * strength, strength);
}
