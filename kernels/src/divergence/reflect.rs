//! Images of vectors.
//!
//! ```text
//! v_g = Q (R (v_s - u(x_s)) + u(x_b))
//! ```
//!
//! Q has the signs of the walls, and R is the map of the body. u is the field of velocities of the body, at the particle and at its image
//! in the body.

use glam::{DVec3, Vec3};

use super::image_rows::{ImageRows, Images, NO_BODY, OfParticles};
use crate::{
    body::{Body, Wrench},
    cpu::Cpu,
};

/// A vector and its curl: velocity and angular velocity of a body, or their rates.
pub(super) type Twist = [Vec3; 2];

/// Velocity and angular velocity of every body.
pub(super) fn velocities(bodies: &[Body]) -> Vec<Twist> {
    bodies.iter().map(|body| [body.state.linear_velocity, body.state.angular_velocity]).collect()
}

/// The same from two columns.
pub(super) fn twists(linear: &[[f32; 4]], angular: &[[f32; 4]]) -> Vec<Twist> {
    linear.iter().zip(angular).map(|(linear, angular)| [vector(linear), vector(angular)]).collect()
}

pub(super) fn vector([x, y, z, _]: &[f32; 4]) -> Vec3 {
    Vec3::new(*x, *y, *z)
}

/// The images of the `values` of particles at `position`, where bodies have the `twists`.
pub(super) fn reflect(
    cpu: &Cpu,
    images: &Images,
    (position, values): (&[[f32; 4]], &[[f32; 4]]),
    (bodies, twists): (&[Body], &[Twist]),
    found: &mut ImageRows,
) {
    found.0.resize(images.position.len(), [0.0; 4]);
    // Padding rows fill up lists, where they must add zeros.
    found.0[images.count()..].fill([0.0; 4]);
    let rows = OfParticles::new(&mut found.0[..images.count()], &images.first);
    cpu.for_chunks(rows, |_, found| {
        let (first, found) = found.all();
        for (row, found) in found.iter_mut().enumerate() {
            let image = first + row;
            let (source, body) = (images.source[image] as usize, images.body[image]);
            let mut value = vector(&values[source]);
            if body != NO_BODY {
                let [linear, angular] = twists[body as usize];
                let centre = bodies[body as usize].state.position;
                let field = |point: &[f32; 4]| linear + angular.cross(vector(point) - centre);
                let relative = value - field(&position[source]);
                value = images.mapped(image, relative) + field(&images.foot[image]);
            }
            *found = (images.signs(image) * value).extend(0.0).to_array();
        }
    });
}

/// Renormalisation along and between the axes, mirrored by the walls with the signs: `Q L Q`.
#[inline(always)]
pub(crate) fn mirrored_renormalisation(q: Vec3, [along, between]: [[f32; 4]; 2]) -> ([f32; 4], [f32; 4]) {
    let ([xx, yy, zz, _], [yz, zx, xy, _]) = (along, between);
    ([xx, yy, zz, 0.0], [yz * q.y * q.z, zx * q.z * q.x, xy * q.x * q.y, 0.0])
}

/// Gives a body what its image receives, less what that hands on to its particle at `point`.
pub(super) fn react(
    images: &Images,
    bodies: &[Body],
    (image, point): (usize, Vec3),
    (force, back): (Vec3, Vec3),
    scale: f64,
    wrenches: &mut [Wrench],
) {
    let body = images.body[image] as usize;
    let centre = bodies[body].state.position;
    let force = images.signs(image) * force;
    let arm = |point: Vec3| (point - centre).as_dvec3();
    let wrench = &mut wrenches[body];
    let scaled = |vector: Vec3| -> DVec3 { vector.as_dvec3() * scale };
    wrench.add(scaled(force), arm(vector(&images.foot[image])));
    wrench.add(-scaled(back), arm(point));
}
