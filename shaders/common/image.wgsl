// Images of particles in walls and bodies. Needs `smoothing`.

// -1 along the axes whose walls mirror an image, else 1.
fn signs_of(image: Image) -> vec3<f32> {
    let bits = (vec3<u32>(image.axes) >> vec3<u32>(0u, 1u, 2u)) & vec3<u32>(1u);
    return 1.0 - 2.0 * vec3<f32>(bits);
}

// c_ij at a distance, of a particle.
fn pair_factor(apart: vec3<f32>) -> f32 {
    let u = closeness(params.smoothing, dot(apart, apart));
    return params.smoothing.gradient * (params.particle_mass / params.rest_density) * (u * u * u);
}

// A symmetric matrix (xx, yy, zz and yz, zx, xy) times a vector.
fn symmetric_times(along: vec3<f32>, between: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return along * v + between.zxy * v.yzx + between.yzx * v.zxy;
}

// The transposed map of the image of a vector back to the particle.
fn back(image: Image, v: vec3<f32>) -> vec3<f32> {
    return symmetric_times(image.along, image.between, signs_of(image) * v);
}

// Elements between the axes of a matrix that the walls of an image mirror.
fn mirrored_between(image: Image, between: vec3<f32>) -> vec3<f32> {
    let signs = signs_of(image);
    return between * signs.yzx * signs.zxy;
}
