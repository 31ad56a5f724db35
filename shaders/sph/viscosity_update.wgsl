// #include sums
// One round of a solve for the implicit viscosity: a step along the direction, the next direction, and the sums that
// `viscosity_round.wgsl` adds up.
//
//     y <- y + alpha p,   r <- r - alpha q,   p <- r + beta p

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_viscosity_product: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_viscosity_solve: ViscositySolve;
@group(0) @binding(4) var<storage, read_write> fluid_viscosity_residual: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> fluid_viscosity_direction: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read_write> fluid_viscosity_change: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read_write> viscosity_sums: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    if (clock.running == 0u) {
        return;
    }
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    var sums = vec4<f32>(0.0);
    if (row < rows) {
        let along = fluid_viscosity_direction[row].xyz;
        let change = fluid_viscosity_change[row].xyz + fluid_viscosity_solve.length * along;
        let residual = fluid_viscosity_residual[row].xyz - fluid_viscosity_solve.length * fluid_viscosity_product[row].xyz;
        fluid_viscosity_change[row] = vec4<f32>(change, 0.0);
        fluid_viscosity_residual[row] = vec4<f32>(residual, 0.0);
        fluid_viscosity_direction[row] = vec4<f32>(residual + fluid_viscosity_solve.share * along, 0.0);
        sums = vec4<f32>(dot(residual, residual), dot(change, change), 0.0, 0.0);
    }
    let all = group_row(lane, sums, false);
    let place = group_of(group, groups);
    if (lane == 0u && place * GROUP < rows) {
        viscosity_sums[place] = all;
    }
}
