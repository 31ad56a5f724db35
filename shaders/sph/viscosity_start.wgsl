// Before the implicit viscosity begins: the velocities in the place of the direction, and zero in that of the product.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read_write> fluid_viscosity_direction: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> fluid_viscosity_product: array<vec4<f32>>;

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
    fluid_viscosity_direction[row] = vec4<f32>(fluid_velocity[row].xyz, 0.0);
    fluid_viscosity_product[row] = vec4<f32>(0.0);
}
