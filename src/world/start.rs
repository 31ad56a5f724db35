//! Changes that a host may make before the first step.

use glam::Vec3;

use super::{World, WorldError, fastest};

/// Largest component of a velocity at time zero \[m/s\], as for [`FluidBlock::velocity`](crate::scene::FluidBlock::velocity).
const MAXIMUM: f32 = 100.0;

impl World {
    /// Gives every particle the velocity of a field at its position, before the first step.
    ///
    /// `velocity` maps a position \[m\] to a velocity \[m/s\], with components from -100 to 100. It replaces the velocities
    /// of the scene ([`FluidBlock::velocity`](crate::scene::FluidBlock::velocity), wet sponges). For `wcsph` set
    /// [`Fluid::sound_speed`](crate::scene::Fluid::sound_speed) as well: its default does not include the field.
    ///
    /// ```
    /// # fn main() -> Result<(), sorb::WorldError> {
    /// use sorb::{World, glam::Vec3, scene::{Fluid, FluidBlock, Scene}};
    ///
    /// let block = FluidBlock::new(Vec3::splat(-0.02), Vec3::splat(0.02));
    /// let scene = Scene::new("spin").with_fluid(Fluid { blocks: vec![block], ..Fluid::default() });
    /// let mut world = World::new(&scene)?;
    /// world.set_particle_velocities(|position| Vec3::new(0.0, 2.0, 0.0).cross(position))?;
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// A step was taken, or the field has a velocity out of range; the world is unchanged.
    pub fn set_particle_velocities(&mut self, velocity: impl Fn(Vec3) -> Vec3) -> Result<(), WorldError> {
        // Later the state may be on a device, and the pressure belongs to the present velocities.
        if self.clock.steps > 0 {
            return Err(WorldError::Started { steps: self.clock.steps });
        }
        let count = self.stores.host.rows.fluid;
        let fluid = &mut self.stores.host.fluid;
        let mut velocities = Vec::with_capacity(count);
        for (row, id) in fluid.position.iter().zip(&fluid.id).take(count) {
            let found = velocity(Vec3::new(row[0], row[1], row[2]));
            // Refuses NaN as well.
            if !found.abs().cmple(Vec3::splat(MAXIMUM)).all() {
                return Err(WorldError::Velocity { id: *id, velocity: found.to_array(), maximum: MAXIMUM });
            }
            velocities.push(found.to_array());
        }
        for (row, [x, y, z]) in fluid.velocity.iter_mut().zip(velocities) {
            // The fourth number is no velocity.
            *row = [x, y, z, row[3]];
        }
        self.clock.fluid_speed = fastest(&fluid.velocity[..count]);
        Ok(())
    }
}
