//! Reflection, refraction and absorption.

use glam::Vec3;

/// Index of refraction of water.
pub(super) const INDEX: f32 = 1.333;

#[cfg(feature = "gpu")]
shared_with_shaders!(OPTICS: INDEX);

/// What the water does to light that passes it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Medium {
    /// Absorption of red, green and blue (1/m).
    pub(super) absorption: Vec3,
    /// Light that it scatters back where it is deep.
    pub(super) scatter: Vec3,
}

impl Medium {
    /// Share of the light that is left after a way (m), by the law of Beer and Lambert.
    pub(super) fn left(&self, way: f32) -> Vec3 {
        (self.absorption * -way).map(libm::expf)
    }
}

/// Direction of the mirrored ray.
pub(super) fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    direction - normal * (2.0 * direction.dot(normal))
}

/// The refracted ray, and the share of the light that is reflected by Fresnel's equations without polarisation; nothing where
/// all is. The normal faces the ray; `ratio` is the index of this side over that of the other.
pub(super) fn refract(direction: Vec3, normal: Vec3, ratio: f32) -> Option<(Vec3, f32)> {
    let cosine = -direction.dot(normal);
    let square = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if square <= 0.0 {
        return None;
    }
    let behind = square.sqrt();
    let across = (ratio * cosine - behind) / (ratio * cosine + behind);
    let parallel = (cosine - ratio * behind) / (cosine + ratio * behind);
    let refracted = direction * ratio + normal * (ratio * cosine - behind);
    Some((refracted.normalize(), 0.5 * (across * across + parallel * parallel)))
}

/// Schlick's approximation of the reflected share of a surface that reflects `upright` of light at a right angle.
pub(super) fn schlick(upright: f32, cosine: f32) -> f32 {
    let slant = (1.0 - cosine).clamp(0.0, 1.0);
    let square = slant * slant;
    upright + (1.0 - upright) * square * square * slant
}
