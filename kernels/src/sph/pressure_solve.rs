//! State of the pressure solve: spectral projected gradient, in the norm of the diagonal \[BB88; BMR00\].
//!
//! ```text
//! s = P_new - P_old,   y = r_old - r_new
//! alpha = s.Ms / s.y  and  s.y / y.(y / M)  in turn;   0.6 in the first two rounds
//! error = mean of (r > 0 ? r : min(-r, P M))
//! ```
//!
//! The error has two sides: pressure that is too high counts as well, as far as it can fall. Without that side a
//! warm-started solve would never reduce a pressure that is too high, and the fluid would gain energy.
//!
//! The tolerance falls with the speed of the fluid. The error that a step leaves becomes a velocity, and waves longer than a
//! few spacings are hardly damped. With a fixed tolerance a pool would oscillate for ever at a speed in proportion to it.

use crate::columns::lane;
use crate::{
    column::ColumnData,
    cpu::PerChunk,
    grid::sort::per_chunk,
    layout::{constants, layout},
    params::Incompressible,
};

constants! {
    /// Length of the first step: a little more than relaxed Jacobi iteration is stable with.
    const FIRST_LENGTH: f32 = 0.6;
    /// Mean error over the mean displacement of a step, in spacings, above which the fluid would not come to rest: what is
    /// left of an error becomes a velocity.
    const ERROR_PER_DISPLACEMENT: f32 = 0.02;
    /// Least tolerance: rounding to f32 leaves no less.
    const MINIMUM_TOLERANCE: f32 = 1.0e-6;
    /// Least length of a step.
    const MINIMUM_LENGTH: f64 = 0.2;
    /// Greatest length of a step.
    const MAXIMUM_LENGTH: f64 = 20.0;
}

/// Sums over the rows of a chunk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sums {
    /// Density error.
    error: f32,
    /// s.Ms
    change: f32,
    /// s.y
    mixed: f32,
    /// y.(y / M)
    response: f32,
    /// Square of the kinematic pressure.
    pressure: f32,
}

impl Sums {
    /// Stores the remaining compression, and sums up.
    pub(super) fn of(rows: &mut [[f32; 4]], left: &[f32]) -> Self {
        let mut sums = Self::default();
        for (row, left) in rows.iter_mut().zip(left) {
            let [pressure, change, diagonal, before] = *row;
            let response = before - left;
            let slack = pressure * diagonal;
            let over = if -left < slack { -left } else { slack };
            sums.error += if *left > 0.0 { *left } else { over };
            sums.change += change * change * diagonal;
            sums.mixed += change * response;
            sums.response += response * response / diagonal;
            sums.pressure += pressure * pressure;
            row[lane::fluid::pressure_rows::COMPRESSION] = *left;
        }
        sums
    }
}

layout! {
    /// What a pressure solve keeps from round to round.
    #[derive(Clone, Copy, Debug, Default)]
    pub(crate) struct Solve {
        /// Length of the next step along the gradient.
        length: f32,
        tolerance: f32,
        error: f32,
        pressure: f32,
        /// Rounds of this step.
        rounds: u32,
        is_converged: bool,
    }
}

/// Where a pressure solve stands.
#[derive(Clone, Debug, Default)]
pub struct PressureSolve {
    pub(crate) state: Solve,
    sums: Vec<Sums>,
    displacements: Vec<f32>,
}

impl PressureSolve {
    /// Iterations of this step.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.state.rounds
    }

    /// Whether the error is below the tolerance.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.state.is_converged
    }

    /// Iterations, whether converged, next step length, error, pressure and tolerance.
    #[cfg(test)]
    pub(crate) fn numbers(&self) -> [f64; 6] {
        [
            f64::from(self.state.rounds),
            f64::from(u8::from(self.state.is_converged)),
            f64::from(self.state.length),
            f64::from(self.state.error),
            f64::from(self.state.pressure),
            f64::from(self.state.tolerance),
        ]
    }

    /// Mean density error after the last iteration, of either sign \[1\].
    #[must_use]
    pub fn error(&self) -> f32 {
        self.state.error
    }

    /// Root mean square of the kinematic pressure \[m^2/s^2\].
    #[must_use]
    pub fn pressure(&self) -> f32 {
        self.state.pressure
    }

    /// Next step length along the gradient.
    pub(crate) fn length(&self) -> f32 {
        self.state.length
    }

    /// Room for the squared displacements of every chunk of `rows` rows.
    pub(super) fn displacements(&mut self, rows: usize) -> PerChunk<'_, f32> {
        per_chunk(&mut self.displacements, rows)
    }

    /// Before the first iteration, with the displacements of `count` particles in the step.
    pub(super) fn begin(&mut self, count: usize, spacing: f32, solve: &Incompressible) {
        let squares: f64 = self.displacements.iter().map(|sum| f64::from(*sum)).sum();
        let displacement = (squares / count.max(1) as f64).sqrt() / f64::from(spacing);
        self.begin_with(displacement as f32, solve);
    }

    /// Before the first iteration, with the root mean square of the displacements in spacings.
    pub(crate) fn begin_with(&mut self, displacement: f32, solve: &Incompressible) {
        let tolerance = (displacement * ERROR_PER_DISPLACEMENT).max(MINIMUM_TOLERANCE).min(solve.tolerance);
        self.state = Solve { length: FIRST_LENGTH, tolerance, ..Solve::default() };
    }

    /// Room for the sums over every chunk of `rows` rows.
    pub(super) fn sums(&mut self, rows: usize) -> PerChunk<'_, Sums> {
        per_chunk(&mut self.sums, rows)
    }

    /// After an iteration over `count` particles.
    pub(super) fn finish_round(&mut self, count: usize, solve: &Incompressible) {
        let mut total = [0.0; 5];
        for Sums { error, change, mixed, response, pressure } in &self.sums {
            for (total, sum) in total.iter_mut().zip([error, change, mixed, response, pressure]) {
                *total += f64::from(*sum);
            }
        }
        self.finish_with(total, count, solve);
    }

    /// After an iteration over `count` particles, with the sums over all of them.
    pub(crate) fn finish_with(
        &mut self,
        [error, change, mixed, response, pressure]: [f64; 5],
        count: usize,
        solve: &Incompressible,
    ) {
        let state = &mut self.state;
        let particles = count.max(1) as f64;
        state.error = (error / particles) as f32;
        state.pressure = (pressure / particles).sqrt() as f32;
        state.rounds += 1;
        state.is_converged = state.error <= state.tolerance || state.rounds >= solve.rounds;
        let ratio = if state.rounds.is_multiple_of(2) { change / mixed } else { mixed / response };
        let is_usable = state.rounds > 1 && mixed > 0.0 && ratio.is_finite();
        state.length =
            if is_usable { ratio.clamp(MINIMUM_LENGTH, MAXIMUM_LENGTH) as f32 } else { FIRST_LENGTH };
    }
}

impl ColumnData for PressureSolve {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        let Solve { rounds, is_converged, length, error, pressure, tolerance } = self.state;
        visit(rounds);
        visit(u32::from(is_converged));
        [length, error, pressure, tolerance].into_iter().for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        let (rounds, is_converged) = (u32::MAX, self.state.is_converged);
        let [length, tolerance, error, pressure] = [f32::NAN; 4];
        self.state = Solve { length, tolerance, error, pressure, rounds, is_converged };
    }
}
