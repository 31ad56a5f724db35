// The sum of `closing.rs` over neighbours and images, of `values` and their images, by all threads of a row.
fn closing_sum(lane: u32, share: SharedRow) -> vec3<f32> {
    let row = share.row;
    let rows = params.fluid_rows;
    let point = fluid_position[row].xyz;
    let own = values[row].xyz;
    var sum = vec3<f32>(0.0);
    let end = fluid_neighbors[row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = fluid_neighbors[row + (k + 1u) * rows];
        let apart = apart_from(point, fluid_position[other].xyz);
        sum += (pair_factor(apart) * dot(values[other].xyz - own, apart)) * apart;
    }
    let seen = fluid_near_images[row];
    for (var k = share.first; k < seen; k += SHARES) {
        let other = fluid_near_images[row + (k + 1u) * rows];
        let there = image_position[other];
        let apart = apart_from(point, there.xyz);
        sum += (there[IMAGE_RATIO] * pair_factor(apart) * dot(fluid_image_vectors[other].xyz - own, apart)) * apart;
    }
    return share_sum3(lane, sum);
}
