// #include smoothing, drag, shares, weighted_velocity
// Drag of the sponge on the particles: one sweep for the impulse of each on the sponge; `drag.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_controls: array<u32>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> control_velocity: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_drag: array<vec4<f32>>;

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
    let sum = weighted_velocity(share, rows, lane);
    if (!share.writes) {
        return;
    }
    if (fluid_controls[row] == 0u) {
        fluid_drag[row] = vec4<f32>(0.0);
        return;
    }
    let inverse = weight_inside(fluid_drag_rate[row][FLUID_DRAG_RATE_NODE_WEIGHT]);
    let rate = fluid_drag_rate[row][FLUID_DRAG_RATE_DRAG_RATE] * clock.step;
    let strength = rate / (1.0 + rate) * params.particle_mass;
    // The column has impulses over chi.
    let old = fluid_drag[row].xyz;
    let lacking = (fluid_velocity[row].xyz - sum.xyz * inverse) * (strength * inverse) - old;
    fluid_drag[row] = vec4<f32>(old + lacking * (1.0 / (1.0 + strength * (sum.w * inverse))), 0.0);
}
