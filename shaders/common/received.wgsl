// Sum over the particles of a control of V_a W_ia times the drag row.
fn received_impulse(own: vec4<f32>, row: u32, rows: u32) -> vec3<f32> {
    let scale = own.w * params.coupling.value;
    let end = list[row];
    var slot = row;
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < end; k += 1u) {
        slot += rows;
        let other = list[slot];
        let apart = own.xyz - position[other].xyz;
        let weight = scale * shape(closeness(params.coupling, dot(apart, apart)));
        sum += drag[other].xyz * weight;
    }
    return sum;
}
