use glam::Vec3;

/// Nearest distance (as a fraction of the distance to the target) at which something is drawn.
const NEAR: f32 = 1e-3;

/// Point of view of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position in m.
    pub eye: Vec3,
    /// Point in the middle of the picture, m.
    pub target: Vec3,
    /// Direction that points up in the picture; any length, not along the line of sight.
    pub up: Vec3,
    /// Vertical field of view in rad, above 0 and below pi.
    pub field_of_view: f32,
}

impl Camera {
    /// A three-quarter view from above that fits the box in a picture of 4:3 or wider.
    #[must_use]
    pub fn framing(minimum: Vec3, maximum: Vec3) -> Self {
        let field_of_view = 0.56_f32;
        let (low, high) = (minimum.min(maximum), minimum.max(maximum));
        let (low, high) = if (high - low).is_finite() { (low, high) } else { (Vec3::ZERO, Vec3::ONE) };
        let half = ((high - low) * 0.5).max(Vec3::splat(1e-4));
        let centre = (low + high) * 0.5;
        let towards_eye = Vec3::new(0.52, 0.50, 1.0).normalize();
        let right = Vec3::Y.cross(towards_eye).normalize();
        let up = towards_eye.cross(right);
        let vertical = libm::tanf(field_of_view * 0.5) * 0.92;
        let horizontal = vertical * 4.0 / 3.0;
        let corner = |i: usize| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            half * Vec3::new(sign(1), sign(2), sign(4))
        };
        // The target moves along the picture's up direction until the top and bottom margins are equal.
        let (mut shift, mut distance) = (0.0_f32, 0.0_f32);
        for _ in 0..8 {
            distance = 0.0;
            for i in 0..8 {
                let p = corner(i) - up * shift;
                let (x, y, depth) = (p.dot(right).abs(), p.dot(up).abs(), p.dot(towards_eye));
                distance = distance.max(depth + (x / horizontal).max(y / vertical));
            }
            let slopes = (0..8).map(|i| {
                let p = corner(i) - up * shift;
                p.dot(up) / (distance - p.dot(towards_eye)).max(1e-6)
            });
            let (bottom, top) = slopes.fold((f32::MAX, f32::MIN), |(a, b), s| (a.min(s), b.max(s)));
            shift += 0.5 * (bottom + top) * distance;
        }
        let target = centre + up * shift;
        Self { eye: target + towards_eye * distance, target, up: Vec3::Y, field_of_view }
    }
}

/// A camera with its raster: `x` to the right and `y` down in samples, depth along `forward` in m.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raster {
    pub(super) eye: Vec3,
    pub(super) right: Vec3,
    pub(super) up: Vec3,
    pub(super) forward: Vec3,
    /// Samples per unit of slope, and its inverse.
    pub(super) focal: f32,
    pub(super) inverse_focal: f32,
    pub(super) near: f32,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Raster {
    pub(super) fn new(camera: &Camera, width: usize, height: usize) -> Self {
        let eye = if camera.eye.is_finite() { camera.eye } else { Vec3::new(1.0, 1.0, 2.0) };
        let sight = camera.target - eye;
        let forward = sight.try_normalize().unwrap_or(Vec3::NEG_Z);
        let right = forward
            .cross(camera.up)
            .try_normalize()
            .filter(|right| right.is_finite())
            .unwrap_or_else(|| forward.any_orthonormal_vector());
        let angle = if camera.field_of_view.is_finite() { camera.field_of_view } else { 0.56 };
        let slope = libm::tanf(angle.clamp(1e-3, 3.1) * 0.5);
        let distance = if sight.is_finite() { sight.length().max(1e-6) } else { 1.0 };
        Self {
            eye,
            right,
            up: right.cross(forward),
            forward,
            focal: 0.5 * height as f32 / slope,
            inverse_focal: slope / (0.5 * height as f32),
            near: distance * NEAR,
            width,
            height,
        }
    }

    /// Coordinates along right, up, forward, seen from the eye.
    pub(super) fn local(&self, point: Vec3) -> Vec3 {
        let p = point - self.eye;
        Vec3::new(p.dot(self.right), p.dot(self.up), p.dot(self.forward))
    }

    /// Sample coordinates of a point in front of the eye.
    pub(super) fn project(&self, local: Vec3) -> (f32, f32) {
        let scale = self.focal / local.z;
        (0.5 * self.width as f32 + local.x * scale, 0.5 * self.height as f32 - local.y * scale)
    }

    /// Slopes to the right and up of the ray through a sample's centre.
    pub(super) fn slopes(&self, x: f32, y: f32) -> (f32, f32) {
        (
            (x + 0.5 - 0.5 * self.width as f32) * self.inverse_focal,
            (0.5 * self.height as f32 - y - 0.5) * self.inverse_focal,
        )
    }

    /// The same view with samples that are so many pixels wide and high.
    pub(super) fn coarser(&self, pixels: usize) -> Self {
        let scale = pixels as f32;
        Self {
            focal: self.focal / scale,
            inverse_focal: self.inverse_focal * scale,
            width: self.width.div_ceil(pixels),
            height: self.height.div_ceil(pixels),
            ..*self
        }
    }
}
