// Applies the drag to the particles: v_i -= J_i / m. The column has impulses over chi.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_drag: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_velocity: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.fluid_rows) {
        return;
    }
    let scale = fluid_drag_rate[row][FLUID_DRAG_RATE_NODE_WEIGHT] * (1.0 / params.particle_mass);
    let before = fluid_velocity[row];
    fluid_velocity[row] = with_vector(before, before.xyz - fluid_drag[row].xyz * scale);
}
