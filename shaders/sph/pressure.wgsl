// Pressure by an equation of state, at least zero: p / rho^2 beside the position, m / rho beside the velocity.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_density: array<f32>;
@group(0) @binding(3) var<storage, read_write> fluid_position: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_velocity: array<vec4<f32>>;

fn pressure(rho: f32) -> f32 {
    let square = params.sound_speed * params.sound_speed;
    if (params.equation_of_state == EQUATION_OF_STATE_LINEAR) {
        return max(square * (rho - params.rest_density), 0.0);
    }
    let ratio = rho / params.rest_density;
    let cube = ratio * ratio * ratio;
    return max(params.rest_density * square * (1.0 / 7.0) * (cube * cube * ratio - 1.0), 0.0);
}

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
    let rho = fluid_density[row];
    fluid_position[row][FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY] = pressure(rho) / (rho * rho);
    fluid_velocity[row][FLUID_VELOCITY_VOLUME] = params.particle_mass / rho;
}
