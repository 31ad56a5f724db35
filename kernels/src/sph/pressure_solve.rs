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

use crate::{
    clock::PEAK_PRESSURE,
    column::ColumnData,
    cpu::PerChunk,
    grid::sort::per_chunk,
    layout::{constants, layout},
    params::{Incompressible, Params},
};

constants! {
    /// Speed of sound over the fastest speed that is expected.
    pub(crate) const SOUND_SPEED_RATIO: f32 = 10.0;
    /// Length of the first step: a little more than relaxed Jacobi iteration is stable with.
    const FIRST_LENGTH: f32 = 0.6;
    /// Mean error over the mean displacement of a step, in spacings, above which the fluid would not come to rest. What is
    /// left of an error becomes a velocity.
    const ERROR_PER_DISPLACEMENT: f32 = 0.02;
    /// Least tolerance: rounding to f32 leaves no less.
    const MINIMUM_TOLERANCE: f32 = 1.0e-6;
    /// The same error of a solve for the divergence, which is left in a layer of one spacing. Errors of one sign add up over the depth.
    const DIVERGENCE_PER_DISPLACEMENT: f32 = 0.2;
    /// Least number of layers that it is divided by.
    const MINIMUM_LAYERS: f32 = 10.0;
    /// Least tolerance of a solve for the divergence.
    const MINIMUM_DIVERGENCE: f32 = 1.0e-5;
    /// Fourth root of the mean fourth power of the error of that solve at most, over the tolerance. An impact on few particles is not
    /// seen in the mean, and must not decide about all of a scene.
    const UNEVENNESS: f32 = 20.0;
    /// Speed that the mean target of the divergence may give all of a pool at rest, over that of a shallow wave on it.
    const MAXIMUM_RISE: f32 = 0.05;
    /// Weight of the pressure of a particle in pores in the bound of the step. Drag and material keep the order of particles there. Steps
    /// may be 0.6 instead of 0.4 of the time in which pressure moves a particle by a spacing.
    pub(crate) const PRESSURE_IN_PORES: f32 = 0.444_444_45;
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
    /// Square of the kinematic pressure, weighted by [`PRESSURE_IN_PORES`] in pores.
    pressure: f32,
    /// Fourth power of the error.
    fourth: f32,
}

/// Sums over the rows of a chunk before a solve for the divergence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Beginning {
    /// Squared speed \[m^2/s^2\].
    speed: f32,
    /// Square of the kinematic pressure of the last step outside of pores \[m^4/s^4\].
    pressure: f32,
    /// Divergence that errors of the density ask for there, times the step.
    target: f32,
    /// Number of particles at a free surface.
    open: f32,
}

impl Beginning {
    /// Of velocities with the pressure beside them, and targets of the divergence, of particles in pores or not, and at a free surface or
    /// not.
    pub(crate) fn of(
        velocity: &[[f32; 4]],
        targets: impl Iterator<Item = f32>,
        places: impl Iterator<Item = (bool, bool)>,
    ) -> Self {
        let mut sums = Self::default();
        for (([x, y, z, pressure], target), (is_in_pores, is_open)) in
            velocity.iter().zip(targets).zip(places)
        {
            sums.speed += x * x + y * y + z * z;
            sums.open += f32::from(u8::from(is_open));
            if !is_in_pores {
                sums.pressure += pressure * pressure;
                sums.target += target;
            }
        }
        sums
    }
}

impl Sums {
    /// Stores the remaining compression, and sums up, with the weights of the pressures.
    pub(crate) fn of(rows: &mut [[f32; 4]], left: &[f32], weights: &[f32]) -> Self {
        let mut sums = Self::default();
        for ((row, left), weight) in rows.iter_mut().zip(left).zip(weights) {
            let [pressure, change, diagonal, compression] = row;
            let (pressure, change, diagonal) = (*pressure, *change, *diagonal);
            let response = *compression - left;
            let slack = pressure * diagonal;
            let over = if -left < slack { -left } else { slack };
            let error = if *left > 0.0 { *left } else { over };
            sums.error += error;
            sums.fourth += error * error * (error * error);
            sums.change += change * change * diagonal;
            sums.mixed += change * response;
            sums.response += response * response / diagonal;
            sums.pressure += weight * pressure * (weight * pressure);
            *compression = *left;
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
        /// With a solve for the divergence: what its target is scaled by, and the speed of the pressure or of the flow \[m/s\].
        target_scale: f32,
        speed: f32,
    }
}

/// Where a pressure solve stands.
#[derive(Clone, Debug, Default)]
pub struct PressureSolve {
    pub(crate) state: Solve,
    sums: Vec<Sums>,
    displacements: Vec<f32>,
    beginnings: Vec<Beginning>,
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

    /// Iterations, whether converged, next step length, error, pressure and tolerance; what the target of the divergence is scaled by, and
    /// the speed of waves.
    #[cfg(test)]
    pub(crate) fn numbers(&self) -> [f64; 8] {
        [
            f64::from(self.state.rounds),
            f64::from(u8::from(self.state.is_converged)),
            f64::from(self.state.length),
            f64::from(self.state.error),
            f64::from(self.state.pressure),
            f64::from(self.state.tolerance),
            f64::from(self.state.target_scale),
            f64::from(self.state.speed),
        ]
    }

    /// Mean density error after the last iteration, of either sign \[1\].
    #[must_use]
    pub fn error(&self) -> f32 {
        self.state.error
    }

    /// Root mean square of the kinematic pressure, with its weight in pores \[m^2/s^2\].
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

    /// Room for the sums before a solve for the divergence.
    pub(crate) fn beginnings(&mut self, rows: usize) -> PerChunk<'_, Beginning> {
        per_chunk(&mut self.beginnings, rows)
    }

    /// Before a solve for the divergence over `count` particles.
    pub(crate) fn begin_divergence(&mut self, count: usize, params: &Params) {
        let mut total = [0.0; 4];
        for Beginning { speed, pressure, target, open } in &self.beginnings {
            for (total, sum) in total.iter_mut().zip([speed, pressure, target, open]) {
                *total += f64::from(*sum);
            }
        }
        self.begin_divergence_with(total, count, params);
    }

    /// The same, with the sums over all of them.
    pub(crate) fn begin_divergence_with(
        &mut self,
        [speed, pressure, target, open]: [f64; 4],
        count: usize,
        params: &Params,
    ) {
        let Some(solve) = &params.fluid.incompressible else { return };
        let (particles, spacing) = (count.max(1) as f64, params.fluid.spacing);
        let gravity = params.gravity.length();
        let speed = (speed / particles).sqrt() as f32;
        // That of the bottom of a pool at rest.
        let pressure = PEAK_PRESSURE * (pressure / particles).sqrt() as f32;
        let wave = pressure.sqrt();
        let layers = if gravity > 0.0 { pressure / (gravity * spacing) } else { 0.0 };
        let layers = layers.max(MINIMUM_LAYERS);
        let displacement = speed * params.step / spacing;
        let tolerance = DIVERGENCE_PER_DISPLACEMENT * displacement / layers;
        let tolerance = tolerance.min(solve.tolerance).max(MINIMUM_DIVERGENCE);
        let target = (target / particles).abs() as f32;
        // A mean rate of expansion t lifts the surface of a pool of depth P / g by t P / g.
        let most = if wave > 0.0 { MAXIMUM_RISE * gravity * params.step / wave } else { 0.0 };
        let target_scale = if target > most && most > 0.0 { most / target } else { 1.0 };
        // In a full vessel water can neither expand nor be compressed: the pressure would grow without end.
        let target_scale = if open > 0.0 { target_scale } else { 0.0 };
        let speed = wave.max(PEAK_PRESSURE * speed);
        // The first iteration sees what the pressure of the step before leaves.
        self.state = Solve { length: 0.0, tolerance, target_scale, speed, ..Solve::default() };
    }

    /// What the target of the divergence is scaled by.
    pub(crate) fn target_scale(&self) -> f32 {
        self.state.target_scale
    }

    /// Speed of shallow waves or of the flow, whichever is larger \[m/s\].
    pub(crate) fn speed(&self) -> f32 {
        self.state.speed
    }

    /// Room for the sums over every chunk of `rows` rows.
    pub(crate) fn sums(&mut self, rows: usize) -> PerChunk<'_, Sums> {
        per_chunk(&mut self.sums, rows)
    }

    /// After an iteration over `count` particles.
    pub(crate) fn finish_round(&mut self, count: usize, solve: &Incompressible) {
        let mut total = [0.0; 6];
        for Sums { error, change, mixed, response, pressure, fourth } in &self.sums {
            for (total, sum) in total.iter_mut().zip([error, change, mixed, response, pressure, fourth]) {
                *total += f64::from(*sum);
            }
        }
        self.finish_with(total, count, solve);
    }

    /// After an iteration over `count` particles, with the sums over all of them.
    pub(crate) fn finish_with(
        &mut self,
        [error, change, mixed, response, pressure, fourth]: [f64; 6],
        count: usize,
        solve: &Incompressible,
    ) {
        let state = &mut self.state;
        let particles = count.max(1) as f64;
        state.error = (error / particles) as f32;
        state.pressure = (pressure / particles).sqrt() as f32;
        state.rounds += 1;
        // A solve for the divergence has a first round that changes no pressure, and stands light bodies (`params::Divergence`).
        let (still, most) = solve.divergence.map_or((0, 1.0), |own| (1, f64::from(own.lightest)));
        let largest = f64::from(UNEVENNESS * state.tolerance);
        let is_even = still == 0 || fourth / particles <= largest * largest * largest * largest;
        let is_small = state.error <= state.tolerance && is_even && state.rounds > still;
        state.is_converged = is_small || state.rounds >= solve.rounds;
        let ratio = if state.rounds.is_multiple_of(2) { change / mixed } else { mixed / response };
        let is_usable = state.rounds > 1 + still && mixed > 0.0 && ratio.is_finite();
        let length = if is_usable { ratio } else { f64::from(FIRST_LENGTH) * most };
        // The square: a plate moves far more water than it displaces, and a length that is too great makes errors grow round by round.
        state.length = length.clamp(MINIMUM_LENGTH * most * most, MAXIMUM_LENGTH) as f32;
    }
}

impl ColumnData for PressureSolve {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        let Solve { rounds, is_converged, length, error, pressure, tolerance, target_scale, speed } =
            self.state;
        visit(rounds);
        visit(u32::from(is_converged));
        [length, error, pressure, tolerance, target_scale, speed]
            .into_iter()
            .for_each(|value| visit(value.to_bits()));
    }
    fn take_words(&mut self, _rows: usize, words: &[u32]) -> bool {
        let [rounds, is_converged, values @ ..] = words else { return false };
        let Ok(values) = <[u32; 6]>::try_from(values) else { return false };
        let [length, error, pressure, tolerance, target_scale, speed] = values.map(f32::from_bits);
        let (rounds, is_converged) = (*rounds, *is_converged != 0);
        self.state = Solve { rounds, is_converged, length, error, pressure, tolerance, target_scale, speed };
        true
    }
    fn poison(&mut self) {
        let (rounds, is_converged) = (u32::MAX, self.state.is_converged);
        let [length, tolerance, error, pressure, target_scale, speed] = [f32::NAN; 6];
        self.state = Solve { length, tolerance, error, pressure, rounds, is_converged, target_scale, speed };
    }
}
