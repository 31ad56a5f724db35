//! Free vibration.

use sorb::glam::DVec3;

use super::{
    Model,
    assembly::{Factors, Freedoms},
    failure,
};
use crate::case::Failure;

impl Model {
    /// Frequency of the lowest mode that moves along a direction, about given positions \[1/s\].
    ///
    /// Inverse iteration from a start along that direction: modes that are orthogonal by symmetry do not appear.
    ///
    /// # Errors
    /// The stiffness is not positive definite, as without held nodes.
    pub fn lowest_frequency(&self, positions: &[DVec3], along: DVec3) -> Result<f64, Failure> {
        let freedoms = Freedoms::new(self);
        let factors = Factors::new(self, &freedoms, positions, 0.0)?
            .ok_or_else(|| failure("the stiffness is not positive definite"))?;
        let mass: Vec<f64> = freedoms.gather(&self.mass.iter().map(|m| DVec3::splat(*m)).collect::<Vec<_>>());
        let mut mode = freedoms.gather(&vec![along; positions.len()]);
        let mut square = 0.0;
        for _ in 0..200 {
            let load: Vec<f64> = mode.iter().zip(&mass).map(|(x, m)| x * m).collect();
            let next = factors.solve(&load);
            // Rayleigh quotient of the new mode: its stiffness times the mode is the load.
            let stiffness: f64 = next.iter().zip(&load).map(|(x, f)| x * f).sum();
            let inertia: f64 = next.iter().zip(&mass).map(|(x, m)| x * x * m).sum();
            let last = std::mem::replace(&mut square, stiffness / inertia);
            let size = inertia.sqrt();
            mode = next.into_iter().map(|x| x / size).collect();
            if (square - last).abs() <= 1e-12 * square {
                break;
            }
        }
        Ok(square.sqrt() / (2.0 * std::f64::consts::PI))
    }
}
