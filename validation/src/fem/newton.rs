//! Static equilibrium.

use sorb::glam::DVec3;

use super::{
    Model,
    assembly::{Factors, Freedoms},
    failure,
};
use crate::case::Failure;

/// Largest number of iterations.
const ITERATIONS: usize = 200;
/// Largest residual force, relative to those of the first iteration and to those on held coordinates: a guess may be as good
/// as rounding allows.
const TOLERANCE: f64 = 1e-10;

impl Model {
    /// Positions at which all free coordinates are in equilibrium \[m\], from a guess whose held coordinates are at their
    /// held places.
    ///
    /// # Errors
    /// Newton's method does not converge.
    pub fn equilibrium(&self, guess: &[DVec3]) -> Result<Vec<DVec3>, Failure> {
        let freedoms = Freedoms::new(self);
        let mut positions = guess.to_vec();
        let held: f64 = self.forces(guess).iter().map(|force| force.length_squared()).sum();
        let mut scale = held.sqrt();
        for _ in 0..ITERATIONS {
            let force = self.left_over(&freedoms, &positions);
            let size = norm(&force);
            scale = scale.max(size);
            if size <= TOLERANCE * scale {
                return Ok(positions);
            }
            let step = self.direction(&freedoms, &positions, &force)?;
            let slope: f64 = step.iter().zip(&force).map(|(a, b)| a * b).sum();
            let start = self.potential(&positions);
            let mut factor = 1.0;
            loop {
                let mut tried = positions.clone();
                freedoms.add(&step, factor, &mut tried);
                let lower = self.potential(&tried) <= start - 1e-4 * factor * slope;
                // Close to the end the energy no longer resolves the step, but the force does.
                if lower || norm(&self.left_over(&freedoms, &tried)) < 0.5 * size {
                    positions = tried;
                    break;
                }
                factor *= 0.5;
                if factor < 1e-8 {
                    return if size <= 1e-6 * scale {
                        Ok(positions)
                    } else {
                        Err(failure(format!("no descent at {size:e} of {scale:e} N")))
                    };
                }
            }
        }
        Err(failure(format!("no equilibrium after {ITERATIONS} iterations")))
    }

    /// Residual forces on the free coordinates \[N\].
    fn left_over(&self, freedoms: &Freedoms, positions: &[DVec3]) -> Vec<f64> {
        let mut forces = self.forces(positions);
        for (force, mass) in forces.iter_mut().zip(&self.mass) {
            *force += self.gravity * *mass;
        }
        freedoms.gather(&forces)
    }

    /// Newton's step, with as much of the identity as makes the stiffness positive definite.
    fn direction(
        &self,
        freedoms: &Freedoms,
        positions: &[DVec3],
        force: &[f64],
    ) -> Result<Vec<f64>, Failure> {
        let mut shift = 0.0;
        for _ in 0..40 {
            if let Some(factors) = Factors::new(self, freedoms, positions, shift)? {
                return Ok(factors.solve(force));
            }
            shift = if shift == 0.0 { 1e-3 } else { 4.0 * shift };
        }
        Err(failure("the stiffness is not positive definite"))
    }
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}
