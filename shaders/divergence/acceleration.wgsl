// #include smoothing, images, image
// Velocities by the pressure of each other; `acceleration.rs` has the formula.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> fluid_predicted: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> fluid_neighbors: array<u32>;
@group(0) @binding(4) var<storage, read> fluid_factors: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read> fluid_renormalisation: array<vec4<f32>>;
@group(0) @binding(6) var<storage, read> fluid_renormalisation_between: array<vec4<f32>>;
@group(0) @binding(7) var<storage, read> fluid_velocity: array<vec4<f32>>;
@group(0) @binding(8) var<storage, read_write> fluid_correction: array<vec4<f32>>;

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
    let rows = params.fluid_rows;
    let own = fluid_predicted[row];
    var sum = own.w * fluid_factors[row].xyz;
    let end = fluid_neighbors[row];
    var slot = row;
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = fluid_neighbors[slot];
        let there = fluid_predicted[other];
        let apart = apart_from(own.xyz, there.xyz);
        let along = fluid_renormalisation[other].xyz;
        let between = fluid_renormalisation_between[other].xyz;
        sum += (pair_factor(apart) * there.w) * symmetric_times(along, between, apart);
    }
    fluid_correction[row] = vec4<f32>(fluid_velocity[row].xyz + clock.step * sum, 0.0);
}
