// First pass of `tets::suction`: force of the suction of a particle on every corner of its tet.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_suction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> fluid_corners: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read> fluid_shares: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> control_position: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> fluid_corner_forces: array<vec4<f32>>;

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
        for (var corner = 0u; corner < 4u; corner += 1u) {
            fluid_corner_forces[4u * row + corner] = vec4<f32>(0.0);
        }
        return;
    }
    let point = fluid_position[row].xyz;
    var around = array<vec3<f32>, 4>();
    var centre = vec3<f32>(0.0);
    var place = vec3<f32>(0.0);
    for (var corner = 0u; corner < 4u; corner += 1u) {
        around[corner] = control_position[corners[corner]].xyz - point;
        centre += 0.25 * around[corner];
        place += fluid_shares[4u * row + corner].w * around[corner];
    }
    // Rows of the inertia of the corners about their centre, each of mass 1.
    var x = vec3<f32>(0.0);
    var y = vec3<f32>(0.0);
    var z = vec3<f32>(0.0);
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let arm = around[corner] - centre;
        let square = dot(arm, arm);
        x += vec3<f32>(square, 0.0, 0.0) - arm.x * arm;
        y += vec3<f32>(0.0, square, 0.0) - arm.y * arm;
        z += vec3<f32>(0.0, 0.0, square) - arm.z * arm;
    }
    let force = fluid_suction[row].xyz * -params.particle_mass;
    let determinant = dot(x, cross(y, z));
    let trace = x.x + y.y + z.z;
    var turn = vec3<f32>(0.0);
    if (determinant > MINIMUM_TURN * trace * trace * trace) {
        let moment = cross(force, place);
        turn = (cross(y, z) * moment.x + cross(z, x) * moment.y + cross(x, y) * moment.z) / determinant;
    }
    for (var corner = 0u; corner < 4u; corner += 1u) {
        let entry = 4u * row + corner;
        fluid_corner_forces[entry] =
            vec4<f32>(fluid_shares[entry].w * force + cross(turn, around[corner] - centre), 0.0);
    }
}
