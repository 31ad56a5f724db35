//! Where the solve for the implicit viscosity stands: conjugate gradients \[HS52\].
//!
//! ```text
//! A = 1 + h D,   A y = -h D v*,   v <- v* + y,   p_0 = r_0 = -h D v*
//!
//! alpha = r.p / p.Ap,   y <- y + alpha p,   r <- r - alpha Ap
//! beta = -r.Ap / p.Ap,  p <- r + beta p
//! ```
//!
//! with `D` from `sph::viscosity_begin`. The solve looks for the change of the velocity: what is rounded away is in proportion to
//! that change, and not to the velocity.
//!
//! There is no preconditioner: the diagonal of `D` is nearly the same for all particles inside, and at a surface it is
//! smaller, which harms nothing. Without one, every change is a sum of products with `D`, and the momentum of the pairs is kept
//! after any number of rounds.
//!
//! The solve stops when the residual is below the tolerance times the change, both as roots of mean squares: as every
//! eigenvalue of `A` is at least one, the error of the velocity is no larger than the residual.

use crate::{column::ColumnData, cpu::PerChunk, grid::sort::per_chunk, params::ImplicitViscosity};

/// Sums over the rows of a chunk: `p.Ap, r.p, r.Ap, Ap.Ap` of a product, `r.r, y.y` of an update.
pub(super) type Sums = [f64; 4];

/// Where a solve for the viscosity stands.
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
    /// Rounds of this step.
    #[must_use]
    pub fn rounds(&self) -> u32 {
        self.rounds
    }

    /// Whether no further round is needed, or allowed.
    #[must_use]
    pub fn is_converged(&self) -> bool {
        self.is_converged
    }

    /// Whether the residual is below the tolerance.
    #[must_use]
    pub fn is_solved(&self) -> bool {
        self.is_solved
    }

    /// Root of the mean square of what is left of the equation after the last round \[m/s\].
    #[must_use]
    pub fn residual(&self) -> f32 {
        self.residual
    }

    /// Root of the mean square of the change of the velocity by viscosity \[m/s\].
    #[must_use]
    pub fn change(&self) -> f32 {
        self.change
    }

    /// Length of the step along the present direction.
    pub(crate) fn length(&self) -> f32 {
        self.length
    }

    /// Share of the present direction in the next one.
    pub(crate) fn share(&self) -> f32 {
        self.share
    }

    /// Rounds, whether it has ended, whether by the tolerance, length, share, residual and change.
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

    /// What a device keeps of it: length, share, residual, change (bits of f32), rounds, whether it has ended, whether by the
    /// tolerance.
    #[cfg(feature = "gpu")]
    pub(crate) fn words(&self) -> [u32; 8] {
        let [length, share, residual, change] =
            [self.length, self.share, self.residual, self.change].map(f32::to_bits);
        let [converged, solved] = [self.is_converged, self.is_solved].map(u32::from);
        [length, share, residual, change, self.rounds, converged, solved, 0]
    }

    /// Takes over what a device keeps of it; words that are missing change nothing.
    #[cfg(feature = "gpu")]
    pub(crate) fn take_words(&mut self, words: &[u32]) {
        if let [length, share, residual, change, rounds, converged, solved, ..] = *words {
            let [length, share, residual, change] = [length, share, residual, change].map(f32::from_bits);
            (self.length, self.share, self.residual, self.change) = (length, share, residual, change);
            (self.rounds, self.is_converged, self.is_solved) = (rounds, converged != 0, solved != 0);
        }
    }

    /// Before the first round.
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

    /// After the product of a round.
    pub(super) fn choose(&mut self) {
        self.choose_with(self.total());
    }

    /// After the product of a round, with the sums over all rows.
    pub(crate) fn choose_with(&mut self, [curvature, slope, residual_product, product_square]: Sums) {
        (self.length, self.share) = (0.0, 0.0);
        // There is no direction where nothing moves.
        if curvature > 0.0 {
            let length = slope / curvature;
            self.length = length as f32;
            self.share = ((length * product_square - residual_product) / curvature) as f32;
        }
    }

    /// After the update of a round over `count` particles.
    pub(super) fn finish_round(&mut self, count: usize, implicit: &ImplicitViscosity) {
        let [residual, change, ..] = self.total();
        self.finish_with([residual, change], count, implicit);
    }

    /// After the update of a round over `count` particles, with the sums over all of them.
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
        // Whether the residual counts is all that is read of it in the end.
        (self.rounds, self.is_solved) = (u32::MAX, !self.is_solved);
        (self.length, self.share) = (f32::NAN, f32::NAN);
        (self.residual, self.change) = (f32::NAN, f32::NAN);
    }
}
