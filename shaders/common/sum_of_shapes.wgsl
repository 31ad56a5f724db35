// Sum of the smoothing function over the neighbours of a particle, before its value. Needs `smoothing` and `images`. The pass binds
// `fluid_position` and `fluid_neighbors`.

fn sum_of_shapes(smoothing: Smoothing, row: u32) -> f32 {
    let point = fluid_position[row].xyz;
    let end = fluid_neighbors[row];
    var slot = row;
    var sum = 0.0;
    for (var k = 0u; k < end; k += 1u) {
        slot += params.fluid_rows;
        let apart = apart_from(point, fluid_position[fluid_neighbors[slot]].xyz);
        sum += shape(closeness(smoothing, dot(apart, apart)));
    }
    return sum;
}
