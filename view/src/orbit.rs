//! A camera that turns around a point.

use sorb::{
    Ray,
    glam::Vec3,
    render::Camera,
    scene::{self, Scene},
};

/// Length of the rays of a mouse \[m\].
const REACH: f32 = 1900.0;

/// Width over height of the pictures that the cameras of scenes are made for; narrower ones see as much from farther away.
const NARROW: f32 = 16.0 / 9.0;

/// A camera that turns around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orbit {
    target: Vec3,
    /// Angle about the vertical axis \[rad\].
    azimuth: f32,
    /// Angle above the horizon \[rad\].
    elevation: f32,
    /// From the target \[m\].
    distance: f32,
    /// Distance at the beginning \[m\].
    first: f32,
    /// Vertical angle of view \[rad\].
    angle: f32,
}

impl Orbit {
    /// The camera of a scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let scene::Camera { eye, target, field_of_view_degrees } = scene.viewpoint();
        let way = eye - target;
        let distance = way.length().max(1e-3);
        Self {
            target,
            azimuth: libm::atan2f(way.x, way.z),
            elevation: libm::asinf((way.y / distance).clamp(-1.0, 1.0)).clamp(-1.5, 1.5),
            distance,
            first: distance,
            angle: field_of_view_degrees.to_radians(),
        }
    }

    /// Turns by angles \[rad\] to the right and upwards.
    pub fn turn(&mut self, right: f32, up: f32) {
        self.azimuth += right;
        self.elevation = (self.elevation + up).clamp(-1.5, 1.5);
    }

    /// Goes nearer by a factor, to a twentieth and to ten times the first distance.
    pub fn zoom(&mut self, factor: f32) {
        self.distance = (self.distance * factor).clamp(0.05 * self.first, 10.0 * self.first);
    }

    /// Moves the picture by shares of its height.
    pub fn pan(&mut self, right: f32, up: f32, aspect: f32) {
        let camera = self.camera(aspect);
        let (x, y, _) = axes(&camera);
        let height = 2.0 * libm::tanf(0.5 * self.angle) * (camera.eye - camera.target).length();
        self.target += (-right * x - up * y) * height;
    }

    /// The camera for pictures so many times as wide as high.
    #[must_use]
    pub fn camera(&self, aspect: f32) -> Camera {
        let flat = libm::cosf(self.elevation);
        let (sine, cosine) = (libm::sinf(self.azimuth), libm::cosf(self.azimuth));
        let way = Vec3::new(flat * sine, libm::sinf(self.elevation), flat * cosine);
        let distance = self.distance * (NARROW / aspect.max(0.1)).max(1.0);
        Camera {
            eye: self.target + way * distance,
            target: self.target,
            up: Vec3::Y,
            field_of_view: self.angle,
        }
    }
}

/// Unit vectors to the right, upwards and forwards.
fn axes(camera: &Camera) -> (Vec3, Vec3, Vec3) {
    let forward = (camera.target - camera.eye).normalize_or(Vec3::NEG_Z);
    let right = forward.cross(camera.up).normalize_or(Vec3::X);
    (right, right.cross(forward), forward)
}

/// The ray through a place of a picture: -1 to 1 to the right and upwards.
#[must_use]
pub fn ray(camera: &Camera, aspect: f32, [x, y]: [f32; 2]) -> Ray {
    let (right, up, forward) = axes(camera);
    let slope = libm::tanf(0.5 * camera.field_of_view);
    let direction = (forward + right * (x * slope * aspect) + up * (y * slope)).normalize();
    Ray { origin: camera.eye, direction, length: REACH }
}

/// Where a ray meets the plane through a point that faces the camera.
#[must_use]
pub fn in_plane(camera: &Camera, ray: &Ray, through: Vec3) -> Vec3 {
    let (_, _, forward) = axes(camera);
    let distance = (through - ray.origin).dot(forward) / ray.direction.dot(forward).max(0.05);
    ray.origin + ray.direction * distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_picture_is_the_target_and_a_turn_keeps_the_distance() {
        let scene = scene::preset("standing").unwrap_or_else(|error| panic!("{error}"));
        let mut orbit = Orbit::new(&scene);
        let first = orbit.camera(1.8);
        assert!((first.eye - scene.viewpoint().eye).length() < 1e-5);
        let middle = ray(&first, 1.8, [0.0, 0.0]);
        assert!((in_plane(&first, &middle, first.target) - first.target).length() < 1e-5);
        orbit.turn(1.0, 0.2);
        let turned = orbit.camera(1.8);
        let distance = |camera: &Camera| (camera.eye - camera.target).length();
        assert!((distance(&turned) - distance(&first)).abs() < 1e-5);
        assert!((turned.eye - first.eye).length() > 0.1);
        // Narrow pictures are seen from farther away.
        assert!(distance(&orbit.camera(0.8)) > 1.5 * distance(&turned));
        orbit.pan(0.5, 0.0, 1.6);
        assert!((orbit.camera(1.6).target - first.target).length() > 0.01);
    }
}
