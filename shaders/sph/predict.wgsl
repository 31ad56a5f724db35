// #include roughness
// Predicted positions at the end of the step without a change of the pressure, kept inside the walls, and the permitted
// compression of `predict.rs`.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_predicted: array<vec4<f32>>;

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
    var end = fluid_position[row].xyz + clock.step * fluid_velocity[row].xyz;
    if (params.has_walls != 0u) {
        let margin = params.spacing * WALL_MARGIN;
        let low = params.wall_low + margin;
        let high = params.wall_high - margin;
        end = select(select(end, high, end > high), low, end < low);
    }
    fluid_predicted[row] = vec4<f32>(end, 0.0);
    var share = 1.0;
    let prompt = prompt_roughness();
    if (prompt < params.roughness) {
        share = prompt / params.roughness;
    }
    // A value above the whole volume is no compression.
    let own = fluid_velocity[row][FLUID_VELOCITY_ALLOWED_COMPRESSION];
    let before = select(0.0, own, abs(own) <= 1.0);
    let asked = fluid_acceleration[row][FLUID_ACCELERATION_ALLOWED_COMPRESSION];
    let allowed = before + share * (asked - before);
    fluid_velocity[row][FLUID_VELOCITY_ALLOWED_COMPRESSION] = allowed;
    fluid_acceleration[row][FLUID_ACCELERATION_ALLOWED_COMPRESSION] = allowed + share * (asked - allowed);
}
