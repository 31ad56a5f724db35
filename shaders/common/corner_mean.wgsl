// Mean of rows of the controls with the weights of the corners of a particle; zero outside of sponges.
fn corner_mean(row: u32) -> vec3<f32> {
    let corners = fluid_corners[row];
    var sum = vec3<f32>(0.0);
    if (corners.x == corners.y) {
        return sum;
    }
    for (var corner = 0u; corner < 4u; corner += 1u) {
        sum += fluid_shares[4u * row + corner].w * controls[corners[corner]].xyz;
    }
    return sum;
}
