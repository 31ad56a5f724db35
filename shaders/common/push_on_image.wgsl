// What the particles around an image in a body give it: `sum_j c_j P_j L_j (x - x_j)`, as `Pushing` in `rate.rs`. Needs `smoothing`,
// `images`, `image` and `shares`. The pass binds `points`, `image_particles` and the renormalisation of particles, and says the
// `pressure_of(point)`.

fn push_on_image(share: SharedRow, lane: u32, at: vec3<f32>) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    let end = image_particles[share.row];
    for (var k = share.first; k < end; k += SHARES) {
        let other = image_particles[share.row + (k + 1u) * params.image_capacity];
        let there = points[other];
        let apart = apart_from(at, there.xyz);
        let along = fluid_renormalisation[other].xyz;
        let between = fluid_renormalisation_between[other].xyz;
        sum += (pair_factor(apart) * pressure_of(there)) * symmetric_times(along, between, apart);
    }
    return share_sum3(lane, sum);
}
