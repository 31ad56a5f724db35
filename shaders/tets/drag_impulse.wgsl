// #include drag
// Drag impulse that every particle loses to the sponge; `drag_impulse.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_drag_rate: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_node: array<u32>;
@group(0) @binding(7) var<storage, read> node_position: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read> node_predicted: array<vec4<f32>>;
@group(0) @binding(9) var<storage, read_write> fluid_drag: array<vec4<f32>>;

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
    let corners = fluid_corners[row];
    if (corners.x == corners.y) {
        fluid_drag[row] = vec4<f32>(0.0);
        return;
    }
    var moved = vec3<f32>(0.0);
    for (var corner = 0u; corner < TET_CORNERS; corner += 1u) {
        // As `node_velocity.wgsl` has it, which may run beside this.
        let node = control_node[corners[corner]];
        let way = node_predicted[node].xyz - node_position[node].xyz;
        moved += fluid_shares[TET_CORNERS * row + corner][CORNER_WEIGHT] * way;
    }
    let relative = fluid_velocity[row].xyz - moved * clock.inverse_step;
    let strength = drag_strength(fluid_drag_rate[row].xy, length(relative), clock.step) * params.particle_mass;
    fluid_drag[row] = vec4<f32>(relative * strength, strength);
}
