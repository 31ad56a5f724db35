//! Questions about the present state: what rays meet, how high the water stands, and what is at points.
//!
//! All of them take many questions at once, which share the preparation. Where a device has the state it answers, and 32 bytes a question
//! come back (`gpu::query`). Rays that may meet sponges, and probes with other solvers than `divergence`, read the state back once a call.
//! The surface of the water is where it fills half of the space around a point ([`WaterField`]). A drop of a single particle has none.

mod error;
pub(crate) mod field;
mod probe;
mod rays;

use glam::Vec3;

pub use error::QueryError;
pub use probe::{Probe, SpongeProbe};
pub use rays::{Hit, Ray, Surface, Targets};

use crate::world::World;
use field::WaterField;

impl World {
    /// What every ray meets first of the targets; none for a ray that meets nothing. A ray that begins in one of them meets it at once.
    /// Bodies and sponges are where they are, without images along periodic axes. Places are exact to about 1e-5 m, those on water
    /// to about a quarter of a spacing.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use sorb::{Ray, Surface, Targets, World, glam::Vec3, scene::{Body, Scene, ShapeKind}};
    ///
    /// let ball = Body::fixed("ball", ShapeKind::Sphere { radius: 0.5 }, Vec3::ZERO);
    /// let world = World::new(&Scene::new("space").with_body(ball))?;
    /// let ray = Ray { origin: Vec3::Y * 2.0, direction: Vec3::NEG_Y, length: 10.0 };
    /// let hits = world.cast_rays(&[ray], Targets::ALL)?;
    /// let hit = hits[0].ok_or("it is there")?;
    /// assert!(hit.surface == Surface::Body(0) && (hit.distance - 1.5).abs() < 1e-4);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// A ray is not finite, has no direction, or a length out of range.
    pub fn cast_rays(&self, rays: &[Ray], targets: Targets) -> Result<Vec<Option<Hit>>, QueryError> {
        rays::cast(self, rays, targets)
    }

    /// Height of the highest surface of water at every x and z \[m\]; none where there is no water. About a quarter of a spacing exact
    /// where water rests; walls of the container do not lower it.
    ///
    /// # Errors
    /// A place is not finite or out of range.
    pub fn water_levels(&self, places: &[[f32; 2]]) -> Result<Vec<Option<f32>>, QueryError> {
        let points: Vec<Vec3> = places.iter().map(|[x, z]| Vec3::new(*x, 0.0, *z)).collect();
        error::check_points(&points)?;
        if let Some(levels) = self.levels_on_device(&points) {
            return Ok(levels);
        }
        let (low, high) = error::bounds(&points);
        let (low, high) = (low.with_y(f32::NEG_INFINITY), high.with_y(f32::INFINITY));
        let water = WaterField::new(self, (low, high));
        let Some((bottom, top)) = water.bounds() else { return Ok(vec![None; places.len()]) };
        let level = |point: &Vec3| {
            let ray = Ray {
                origin: point.with_y(top.y + 1e-3),
                direction: Vec3::NEG_Y,
                length: top.y - bottom.y + 2e-3,
            };
            water.meets(&ray).map(|distance| ray.origin.y - distance)
        };
        Ok(points.iter().map(level).collect())
    }

    /// What is at every point: water around it, and the sponge that it lies in.
    ///
    /// # Errors
    /// A point is not finite or out of range.
    pub fn probe(&self, points: &[Vec3]) -> Result<Vec<Probe>, QueryError> {
        probe::probe(self, points)
    }
}
