// #include smoothing, images, shares
// Acceleration by gravity, pressure and viscosity.
//
//     a_i = g - sum_j m (p_i / rho_i^2 + p_j / rho_j^2) grad W_ij + mu / rho_i sum_j V_j (v_j - v_i) lap W_visc(r_ij)
//         + 10 mu_c / rho_i sum_j V_j (v_j - v_i) . x_ij / (r_ij^2 + 0.0025 H^2) x_ij (-dW/dr) / r_ij
//     w_i = e sum_j c_ij (q_j - q_i),   q = P - g . x

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(5) var<storage, read_write> fluid_acceleration: array<vec4<f32>>;

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
    let own = fluid_position[row];
    let own_pressure = own[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY];
    let own_velocity = fluid_velocity[row];
    let has_pairs = params.divergence == 0u || params.viscosity + params.central_viscosity > 0.0;
    let end = select(0u, fluid_neighbors[row], has_pairs);
    var push = vec3<f32>(0.0);
    var pull = vec3<f32>(0.0);
    var central = vec3<f32>(0.0);
    var roughness = 0.0;
    // With a pressure solve particles keep their volume, and the fourth lane of the velocity has another quantity.
    let is_known = params.incompressible != 0u;
    let rest_volume = params.particle_mass / params.rest_density;
    let own_volume = select(own_velocity[FLUID_VELOCITY_VOLUME], rest_volume, is_known);
    let softening = SOFTENING * params.smoothing.support_radius * params.smoothing.support_radius;
    let weight = params.gravity / params.rest_density;
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let there = fluid_position[other];
        let its_velocity = fluid_velocity[other];
        let apart = apart_from(own.xyz, there.xyz);
        let square = dot(apart, apart);
        let u = closeness(params.smoothing, square);
        let cube = u * u * u;
        let relative = its_velocity.xyz - own_velocity.xyz;
        // A solve for the divergence has all of the pressure.
        if (params.divergence == 0u) {
            let its_pressure = there[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY];
            push += ((own_pressure + its_pressure) * cube) * apart;
            if (min(own_pressure, its_pressure) > 0.0) {
                roughness += cube * (its_pressure - own_pressure + dot(weight, apart));
            }
        }
        let volume = select(its_velocity[FLUID_VELOCITY_VOLUME], rest_volume, is_known);
        pull += (volume * u) * relative;
        central += (volume * cube * dot(relative, apart) / (square + softening)) * apart;
    }
    // mu / rho_i = mu V_i / m.
    let pressure_scale = params.smoothing.gradient * params.particle_mass;
    let viscosity_scale = params.smoothing.viscosity * (params.viscosity / params.particle_mass) * own_volume;
    let central_scale =
        params.smoothing.gradient * (10.0 * params.central_viscosity / params.particle_mass) * own_volume;
    let part = push * pressure_scale + pull * viscosity_scale + central * central_scale;
    let sum = share_sum(lane, vec4<f32>(part, roughness * (pressure_scale * params.roughness)));
    if (share.writes) {
        fluid_acceleration[row] = with_vector(sum, sum.xyz + params.gravity);
    }
}
