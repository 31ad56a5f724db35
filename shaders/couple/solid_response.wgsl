// Third pass of `couple::solid_response`: the velocities of the nodes; `solid_response.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> control_material: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> control_compliance: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read> control_expected: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> control_force: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> control_impulse: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> control_solved: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    if (clock.running == 0u || row >= params.node_rows) {
        return;
    }
    let response = control_compliance[row];
    let force = control_force[row].xyz * (response[CONTROL_COMPLIANCE_VOLUME] * params.solid.gradient * params.particle_mass);
    let received = force * clock.step + control_solved[row].xyz;
    let velocity = control_material[row].xyz + response[CONTROL_COMPLIANCE_COMPLIANCE] * (received + control_expected[row].xyz);
    control_force[row] = vec4<f32>(force, 0.0);
    control_impulse[row] = vec4<f32>(received, 0.0);
    control_solved[row] = vec4<f32>(velocity, response[CONTROL_COMPLIANCE_VOLUME]);
}
