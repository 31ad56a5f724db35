// #include smoothing, control_group
// Reaction of the nodes to the pressure of the particles; `solid_reaction.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> control_solid: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_node: array<u32>;
@group(0) @binding(7) var<storage, read> control_fluid: array<u32>;
@group(0) @binding(8) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> node_acceleration: array<vec4<f32>>;

@compute @workgroup_size(GROUP_THREADS)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = control_row(group, groups, lane);
    let is_row = row < params.node_rows;
    let last = params.node_rows - 1u;
    let before = control_position[min(row, last)].xyz;
    let solid = control_solid[min(row, last)];
    let first = row * (params.control_fluid_capacity + 1u);
    var end = 0u;
    if (is_row) {
        end = control_fluid[first];
    }
    var part = vec3<f32>(0.0);
    for (var k = lane % CONTROL_THREADS; k < end; k += CONTROL_THREADS) {
        let other = control_fluid[first + 1u + k];
        let particle = fluid_position[other];
        let apart = before - particle.xyz;
        let u = closeness(params.solid, dot(apart, apart));
        part += (particle[FLUID_POSITION_PRESSURE_OVER_SQUARED_DENSITY] * params.rest_density * (u * u * u)) * apart;
        let moved = fluid_predicted[other];
        let apart_after = solid.xyz - moved.xyz;
        let u_after = closeness(params.solid, dot(apart_after, apart_after));
        part += (moved[FLUID_PREDICTED_PRESSURE_CHANGE] * (u_after * u_after * u_after)) * apart_after;
    }
    let sum = control_sum(lane, vec4<f32>(part, 0.0)).xyz;
    if (!is_row || lane % CONTROL_THREADS != 0u) {
        return;
    }
    let force = sum * (solid[CONTROL_SOLID_VOLUME] * params.solid.gradient * params.particle_mass);
    let node = control_node[row];
    let old = node_acceleration[node];
    let gained = force * node_position[node][NODE_POSITION_INVERSE_MASS];
    let length = sqrt(dot(gained, gained));
    let most = params.correction_speed * clock.inverse_step;
    let share = select(1.0, most / length, length > most);
    node_acceleration[node] = with_vector(old, old.xyz + gained * share);
}
