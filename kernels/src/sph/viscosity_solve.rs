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

use crate::{column::ColumnData, cpu::PerChunk, grid::sort::per_chunk, params::ImplicitViscosity};

/// Sums over the rows of a chunk: `p.Ap, r.p, r.Ap, Ap.Ap` of a product, `r.r, y.y` of an update.
pub(super) type Sums = [f64; 4];

/// State of the solve for the viscosity.
#[derive(Clone, Debug, Default)]
pub struct ViscositySolve {
    rounds: u32,
    is_converged: bool,
    is_solved: bool,
    length: f32,
    share: f32,
    residual: f32,
    change: f32,
    sums: Vec<Sums>,
}

impl ViscositySolve {
    /// Iterations of this step.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Whether no further iteration is needed, or allowed.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.is_converged
    }

    /// Whether the residual is below the tolerance.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.is_solved
    }

    /// Root mean square of the residual after the last iteration \[m/s\].
    #[must_use]
    pub fn residual(&self) -> f32 {
        self.residual
    }

    /// Root mean square of the change of the velocity by viscosity \[m/s\].
    #[must_use]
    pub fn change(&self) -> f32 {
        self.change
    }

    /// Step length along the present direction.
    pub(crate) fn length(&self) -> f32 {
        self.length
    }

    /// Share of the present direction in the next one.
    pub(crate) fn share(&self) -> f32 {
        self.share
    }

    /// Iterations, whether it has ended, whether by the tolerance, step length, share, residual and change.
    #[cfg(test)]
    pub(crate) fn numbers(&self) -> [f64; 7] {
        [
            f64::from(self.rounds),
            f64::from(u8::from(self.is_converged)),
            f64::from(u8::from(self.is_solved)),
            f64::from(self.length),
            f64::from(self.share),
            f64::from(self.residual),
            f64::from(self.change),
        ]
    }

    /// Words of the state on a device: step length, share, residual, change (bits of f32), iterations, whether it has ended,
    /// whether by the tolerance.
    #[cfg(feature = "gpu")]
    pub(crate) fn words(&self) -> [u32; 8] {
        let [length, share, residual, change] =
            [self.length, self.share, self.residual, self.change].map(f32::to_bits);
        let [converged, solved] = [self.is_converged, self.is_solved].map(u32::from);
        [length, share, residual, change, self.rounds, converged, solved, 0]
    }

    /// Takes the state from the words of a device; missing words change nothing.
    #[cfg(feature = "gpu")]
    pub(crate) fn take_words(&mut self, words: &[u32]) {
        if let [length, share, residual, change, rounds, converged, solved, ..] = *words {
            let [length, share, residual, change] = [length, share, residual, change].map(f32::from_bits);
            (self.length, self.share, self.residual, self.change) = (length, share, residual, change);
            (self.rounds, self.is_converged, self.is_solved) = (rounds, converged != 0, solved != 0);
        }
    }

    /// Before the first iteration.
    pub(crate) fn begin(&mut self) {
        let sums = std::mem::take(&mut self.sums);
        *self = Self { sums, ..Self::default() };
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
        (self.length, self.share) = (0.0, 0.0);
        // Without motion there is no direction.
        if curvature > 0.0 {
            let length = slope / curvature;
            self.length = length as f32;
            self.share = ((length * product_square - residual_product) / curvature) as f32;
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
        let particles = count.max(1) as f64;
        self.residual = (residual / particles).sqrt() as f32;
        self.change = (change / particles).sqrt() as f32;
        self.rounds += 1;
        self.is_solved = self.residual <= implicit.tolerance * self.change;
        self.is_converged = self.is_solved || self.rounds >= implicit.rounds;
    }
}

impl ColumnData for ViscositySolve {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        [self.rounds, u32::from(self.is_converged), u32::from(self.is_solved)]
            .into_iter()
            .for_each(&mut *visit);
        [self.length, self.share, self.residual, self.change]
            .into_iter()
            .for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        // In the end only the flag of the tolerance is read.
        (self.rounds, self.is_solved) = (u32::MAX, !self.is_solved);
        (self.length, self.share) = (f32::NAN, f32::NAN);
        (self.residual, self.change) = (f32::NAN, f32::NAN);
    }
}
