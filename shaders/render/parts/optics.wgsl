// Reflection, refraction and absorption.

// Share of the light that is left after a way (m), by the law of Beer and Lambert.
fn left_after(way: f32) -> vec3<f32> {
    return exp(scene.absorption * -way);
}

struct Refraction {
    direction: vec3<f32>,
    // Share of the light that is mirrored.
    mirrored: f32,
    // Whether any light passes.
    passes: bool,
}

// Snell's law and Fresnel's equations without polarisation. The normal faces the ray; `ratio` is the index of this side over that of
// the other.
fn refracted(direction: vec3<f32>, normal: vec3<f32>, ratio: f32) -> Refraction {
    let cosine = -dot(direction, normal);
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if (square <= 0.0) {
        return Refraction(direction, 1.0, false);
    }
    let behind = sqrt(square);
    let across = (ratio * cosine - behind) / (ratio * cosine + behind);
    let parallel = (cosine - ratio * behind) / (cosine + ratio * behind);
    let towards = normalize(direction * ratio + normal * (ratio * cosine - behind));
    return Refraction(towards, 0.5 * (across * across + parallel * parallel), true);
}

// Schlick's approximation of the reflected share of a surface that reflects `upright` of light at a right angle.
fn schlick(upright: f32, cosine: f32) -> f32 {
    let slant = clamp(1.0 - cosine, 0.0, 1.0);
    let square = slant * slant;
    return upright + (1.0 - upright) * square * square * slant;
}
