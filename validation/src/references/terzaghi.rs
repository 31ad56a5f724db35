//! Consolidation of a soaked layer that is compressed (Terzaghi, as stress relaxation).

use std::f64::consts::PI;

/// A layer between a sealed floor and a drained top that is pushed down at a constant speed for a while, and then held.
///
/// The displacement `w` at a height `z` follows `dw/dt = c_v d2w/dz2`, `c_v = K M / mu`. The pore pressure is the difference
/// of the stress to that at the top: `u = M (dw/dz(H) - dw/dz(z))`. Small strain, constant permeability, no inertia.
#[derive(Clone, Copy, Debug)]
pub struct Layer {
    /// Height \[m\].
    pub height: f64,
    /// Modulus of confined compression \[Pa\].
    pub modulus: f64,
    /// Permeability \[m^2\].
    pub permeability: f64,
    /// Dynamic viscosity of the water \[Pa s\].
    pub viscosity: f64,
    /// Speed of the top while it moves \[m/s\].
    pub speed: f64,
    /// Time over which it moves \[s\].
    pub moves: f64,
}

/// Terms of the series: the remainder is a thousandth of the pressure.
const TERMS: u32 = 400;

impl Layer {
    /// Time scale of consolidation, `H^2 / c_v` \[s\].
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.height * self.height * self.viscosity / (self.permeability * self.modulus)
    }

    /// Downward displacement at a height above the floor \[m\].
    #[must_use]
    pub fn sunk(&self, above_floor: f64, time: f64) -> f64 {
        let z = above_floor / self.height;
        self.since_start(time, |time| {
            let series = self.sum(time, |x| libm::sin(x * z) / (x * x * x));
            z * time + 2.0 * self.duration() * series
        })
    }

    /// Pore pressure above the hydrostatic one at a height above the floor \[Pa\].
    #[must_use]
    pub fn pressure(&self, above_floor: f64, time: f64) -> f64 {
        let z = above_floor / self.height;
        let strain = self.since_start(time, |time| {
            // The cosine at the top is the sign of the term.
            let top = self.sum_signed(time, |x| 1.0 / (x * x));
            let here = self.sum(time, |x| libm::cos(x * z) / (x * x));
            2.0 * self.duration() * (top - here)
        });
        self.modulus * strain / self.height
    }

    /// Response to the motion of the top: that to an endless motion less that to its continuation after the end.
    fn since_start(&self, time: f64, ramp: impl Fn(f64) -> f64) -> f64 {
        let after = if time > self.moves { ramp(time - self.moves) } else { 0.0 };
        self.speed * (ramp(time.max(0.0)) - after)
    }

    /// `sum (-1)^n f(n pi) (1 - exp(-(n pi)^2 T))`.
    fn sum(&self, time: f64, f: impl Fn(f64) -> f64) -> f64 {
        self.sum_signed(time, |x| if libm::cos(x) > 0.0 { f(x) } else { -f(x) })
    }

    fn sum_signed(&self, time: f64, f: impl Fn(f64) -> f64) -> f64 {
        let share = time / self.duration();
        (1..=TERMS).map(|n| f64::from(n) * PI).map(|x| f(x) * (1.0 - libm::exp(-x * x * share))).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYER: Layer =
        Layer { height: 0.05, modulus: 2e4, permeability: 3e-10, viscosity: 1e-3, speed: 0.01, moves: 0.1 };

    /// `dw/dt = c_v d2w/dz2` by small explicit steps: the displacement at half height, and the pressure at the floor.
    fn stepped(time: f64, diffusion: f64) -> (f64, f64) {
        const CELLS: usize = 100;
        let size = LAYER.height / CELLS as f64;
        let steps = (time * diffusion / (0.02 * size * size)).ceil();
        let ratio = time / steps * diffusion / (size * size);
        let mut w = vec![0.0; CELLS + 1];
        let mut step = 0.0;
        while step < steps {
            let old = w.clone();
            for i in 1..CELLS {
                w[i] += ratio * (old[i - 1] - 2.0 * old[i] + old[i + 1]);
            }
            step += 1.0;
            w[CELLS] = LAYER.speed * f64::min(time * step / steps, LAYER.moves);
        }
        // One-sided differences of second order.
        let floor = (4.0 * w[1] - w[2]) / (2.0 * size);
        let top = (3.0 * w[CELLS] - 4.0 * w[CELLS - 1] + w[CELLS - 2]) / (2.0 * size);
        (w[CELLS / 2], LAYER.modulus * (top - floor))
    }

    #[test]
    fn the_series_is_the_solution_of_its_equation() {
        let diffusion = LAYER.permeability * LAYER.modulus / LAYER.viscosity;
        for time in [0.03, 0.1, 0.15, 0.4] {
            let (way, pressure) = stepped(time, diffusion);
            let (found, borne) = (LAYER.sunk(0.025, time), LAYER.pressure(0.0, time));
            assert!((found - way).abs() < 2e-6, "{time}: {found}, {way}");
            assert!((borne - pressure).abs() < 4.0, "{time}: {borne}, {pressure}");
            // Negative control: half the permeability is another problem.
            let (_, slower) = stepped(time, 0.5 * diffusion);
            assert!((slower - borne).abs() > 20.0, "{time}: {borne}, {slower}");
        }
    }

    #[test]
    fn it_ends_evenly_compressed_with_no_pressure() {
        let (end, way) = (20.0 * LAYER.duration(), LAYER.speed * LAYER.moves);
        assert!((LAYER.sunk(0.02, end) / way - 0.4).abs() < 1e-6);
        assert!(LAYER.pressure(0.0, end).abs() < 1e-3);
        assert!((LAYER.sunk(LAYER.height, 0.02) / (0.02 * LAYER.speed) - 1.0).abs() < 1e-6);
    }
}
