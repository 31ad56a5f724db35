// Surface tension as cohesion between particles; `cohesion.rs` has the formulas.

@group(0) @binding(0) var<uniform> clock: Clock;
@group(0) @binding(1) var<uniform> params: Params;
@group(0) @binding(2) var<storage, read> position: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> list: array<u32>;
@group(0) @binding(4) var<storage, read_write> acceleration: array<vec4<f32>>;

@compute @workgroup_size(GROUP)
fn main(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) lane: u32,
) {
    let row = row_of(group, groups, lane);
    let rows = params.fluid_rows;
    if (clock.running == 0u || row >= rows) {
        return;
    }
    let own = position[row].xyz;
    let end = list[row];
    var slot = row;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let apart = own - position[list[slot]].xyz;
        let square = dot(apart, apart);
        let u = closeness(params.smoothing, square);
        let product = u * (1.0 - u);
        let cube = product * product * product;
        let pull = select(cube, cube + cube - 1.0 / 64.0, u > 0.5);
        sum += apart * (pull / max(sqrt(square), params.smoothing.radius * 1.0e-6));
    }
    let before = acceleration[row];
    acceleration[row] = vec4<f32>(before.xyz - sum * params.cohesion, before.w);
}
