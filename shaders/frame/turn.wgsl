// What a turn of the container in a step does to velocities: v <- C v + F x.

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<uniform> turn: Turn;
@group(0) @binding(2) var<storage, read> positions: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> velocities: array<vec4<f32>>;

fn turned(position: vec3<f32>, velocity: vec4<f32>) -> vec4<f32> {
    let coriolis = mat3x3<f32>(turn.coriolis_x.xyz, turn.coriolis_y.xyz, turn.coriolis_z.xyz);
    let field = mat3x3<f32>(turn.field_x.xyz, turn.field_y.xyz, turn.field_z.xyz);
    return with_vector(velocity, coriolis * velocity.xyz + field * position);
}

@compute @workgroup_size(GROUP)
fn particles(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (row < params.fluid_rows) {
        velocities[row] = turned(positions[row].xyz, velocities[row]);
    }
}

// Nodes that a body holds move with it.
@compute @workgroup_size(GROUP)
fn nodes(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (row < params.node_rows && positions[row][NODE_POSITION_INVERSE_MASS] > 0.0) {
        velocities[row] = turned(positions[row].xyz, velocities[row]);
    }
}
