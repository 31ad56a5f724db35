// End of an iteration of position based fluids: moves the particles towards rest density, and their velocities accordingly.
//
//     x*_i += h^2 a_i,   v_i += h a_i

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_correction: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_predicted: array<vec4<f32>>;

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
    let change = clock.step * fluid_correction[row].xyz;
    let before = fluid_predicted[row];
    var end = before.xyz + clock.step * change;
    if (params.has_walls != 0u) {
        let margin = params.spacing * WALL_MARGIN;
        let low = params.wall_low + margin;
        let high = params.wall_high - margin;
        end = select(select(end, high, end > high), low, end < low);
    }
    fluid_predicted[row] = with_vector(before, end);
    let velocity_before = fluid_velocity[row];
    fluid_velocity[row] = with_vector(velocity_before, velocity_before.xyz + change);
}
