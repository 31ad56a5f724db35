//! State of the solve for the implicit viscosity: conjugate gradients \[HS52\].
//!
//! ```text
//! A = 1 + h D,   A y = -h D v*,   v <- v* + y,   p_0 = r_0 = -h D v*
//!
//! alpha = r.p / p.Ap,   y <- y + alpha p,   r <- r - alpha Ap
//! beta = -r.Ap / p.Ap,  p <- r + beta p
//! ```
//!
//! with `D` from `sph::viscosity_begin`. The unknown is the change of the velocity: rounding errors are then in proportion
//! to the change, not to the velocity.
//!
//! There is no preconditioner: the diagonal of `D` varies little inside the fluid, and is smaller at a surface, which does
//! no harm. Without one, every change is a sum of products with `D`, and momentum is conserved after any number of
//! iterations.
//!
//! The solve stops when the residual is below the tolerance times the change, both as root mean squares. Every eigenvalue of
//! `A` is at least one, so that the error of the velocity is at most the residual.

use crate::{
    column::ColumnData, cpu::PerChunk, grid::sort::per_chunk, layout::layout, params::ImplicitViscosity,
};

/// Sums over the rows of a chunk: `p.Ap, r.p, r.Ap, Ap.Ap` of a product, `r.r, y.y` of an update.
pub(super) type Sums = [f64; 4];

layout! {
    /// What a solve for the viscosity keeps from round to round.
    #[derive(Clone, Copy, Debug, Default)]
    pub(crate) struct State as ViscositySolve {
        /// Length of the step along the present direction.
        length: f32,
        /// Share of the present direction in the next one.
        share: f32,
        residual: f32,
        change: f32,
        /// Rounds of this step.
        rounds: u32,
        is_converged: bool,
        /// Whether the residual is below the tolerance.
        is_solved: bool,
    }
}

/// Where a solve for the viscosity stands.
#[derive(Clone, Debug, Default)]
pub struct ViscositySolve {
    pub(crate) state: State,
    sums: Vec<Sums>,
}

impl ViscositySolve {
    /// Iterations of this step.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.state.rounds
    }

    /// Whether no further iteration is needed, or allowed.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.state.is_converged
    }

    /// Whether the residual is below the tolerance.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.state.is_solved
    }

    /// Root mean square of the residual after the last iteration \[m/s\].
    #[must_use]
    pub fn residual(&self) -> f32 {
        self.state.residual
    }

    /// Root mean square of the change of the velocity by viscosity \[m/s\].
    #[must_use]
    pub fn change(&self) -> f32 {
        self.state.change
    }

    /// Step length along the present direction.
    pub(crate) fn length(&self) -> f32 {
        self.state.length
    }

    /// Share of the present direction in the next one.
    pub(crate) fn share(&self) -> f32 {
        self.state.share
    }

    /// Iterations, whether it has ended, whether by the tolerance, step length, share, residual and change.
    #[cfg(test)]
    pub(crate) fn numbers(&self) -> [f64; 7] {
        [
            f64::from(self.state.rounds),
            f64::from(u8::from(self.state.is_converged)),
            f64::from(u8::from(self.state.is_solved)),
            f64::from(self.state.length),
            f64::from(self.state.share),
            f64::from(self.state.residual),
            f64::from(self.state.change),
        ]
    }

    /// Before the first round.
    pub(crate) fn begin(&mut self) {
        self.state = State::default();
    }

    /// Room for the sums over every chunk of `rows` rows.
    pub(super) fn sums(&mut self, rows: usize) -> PerChunk<'_, Sums> {
        per_chunk(&mut self.sums, rows)
    }

    /// The sums over all rows, in the order of the chunks.
    fn total(&self) -> Sums {
        let mut total = [0.0; 4];
        for sums in &self.sums {
            for (total, sum) in total.iter_mut().zip(sums) {
                *total += sum;
            }
        }
        total
    }

    /// After the product of an iteration.
    pub(super) fn choose(&mut self) {
        self.choose_with(self.total());
    }

    /// After the product of an iteration, with the sums over all rows.
    pub(crate) fn choose_with(&mut self, [curvature, slope, residual_product, product_square]: Sums) {
        (self.state.length, self.state.share) = (0.0, 0.0);
        // There is no direction where nothing moves.
        if curvature > 0.0 {
            let length = slope / curvature;
            self.state.length = length as f32;
            self.state.share = ((length * product_square - residual_product) / curvature) as f32;
        }
    }

    /// After the update of an iteration over `count` particles.
    pub(super) fn finish_round(&mut self, count: usize, implicit: &ImplicitViscosity) {
        let [residual, change, ..] = self.total();
        self.finish_with([residual, change], count, implicit);
    }

    /// After the update of an iteration over `count` particles, with the sums over all of them.
    pub(crate) fn finish_with(
        &mut self,
        [residual, change]: [f64; 2],
        count: usize,
        implicit: &ImplicitViscosity,
    ) {
        let state = &mut self.state;
        let particles = count.max(1) as f64;
        state.residual = (residual / particles).sqrt() as f32;
        state.change = (change / particles).sqrt() as f32;
        state.rounds += 1;
        state.is_solved = state.residual <= implicit.tolerance * state.change;
        state.is_converged = state.is_solved || state.rounds >= implicit.rounds;
    }
}

impl ColumnData for ViscositySolve {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        let State { length, share, residual, change, rounds, is_converged, is_solved } = self.state;
        [rounds, u32::from(is_converged), u32::from(is_solved)].into_iter().for_each(&mut *visit);
        [length, share, residual, change].into_iter().for_each(|value| visit(value.to_bits()));
    }
    fn take_words(&mut self, _rows: usize, words: &[u32]) -> bool {
        let &[rounds, converged, solved, length, share, residual, change] = words else { return false };
        let [length, share, residual, change] = [length, share, residual, change].map(f32::from_bits);
        let (is_converged, is_solved) = (converged != 0, solved != 0);
        self.state = State { length, share, residual, change, rounds, is_converged, is_solved };
        true
    }
    fn poison(&mut self) {
        // Whether the residual counts is all that is read of it in the end.
        let State { is_converged, is_solved, .. } = self.state;
        let ([length, share, residual, change], rounds) = ([f32::NAN; 4], u32::MAX);
        self.state = State { length, share, residual, change, rounds, is_converged, is_solved: !is_solved };
    }
}
