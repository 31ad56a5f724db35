//! Water in pores: Darcy's law with a sharp front (Green and Ampt, Lucas and Washburn).

use crate::norms::interpolated;

/// A porous block and the water that it absorbs.
#[derive(Clone, Copy, Debug)]
pub struct Pores {
    /// Permeability \[m^2\].
    pub permeability: f64,
    /// Pore volume over volume \[1\].
    pub porosity: f64,
    /// Capillary pressure at the front \[Pa\].
    pub entry_pressure: f64,
    /// Dynamic viscosity of the water \[Pa s\].
    pub viscosity: f64,
    /// Its density \[kg/m^3\].
    pub density: f64,
}

impl Pores {
    /// Position of the front after a time without gravity \[m\]: `sqrt(2 K p_e t / (phi mu))`.
    #[must_use]
    pub fn front(&self, time: f64) -> f64 {
        (2.0 * self.permeability * self.entry_pressure * time / (self.porosity * self.viscosity))
            .max(0.0)
            .sqrt()
    }

    /// Time at which the front reaches a position without gravity \[s\], the inverse of [`Self::front`].
    #[must_use]
    pub fn time(&self, front: f64) -> f64 {
        front * front * self.porosity * self.viscosity / (2.0 * self.permeability * self.entry_pressure)
    }

    /// Final height of the front above the level \[m\]: `p_e / (rho g)`.
    #[must_use]
    pub fn rise(&self, gravity: f64) -> f64 {
        self.entry_pressure / (self.density * gravity)
    }

    /// Time and height of the front above the level outside \[s, m\], in a bath whose level falls as the block absorbs
    /// water: `phi dz/dt = (K rho g / mu) (H - x) / x` with `x = z - level`, and `A_out dlevel = -phi A dz`.
    ///
    /// `ratio` is `phi A / A_out`; the front starts at the level, after a thousandth of the rise.
    #[must_use]
    pub fn bath(&self, gravity: f64, ratio: f64, seconds: f64) -> Vec<(f64, f64)> {
        let rise = self.rise(gravity);
        let speed = self.permeability * self.density * gravity / (self.porosity * self.viscosity);
        let rate = |x: f64| speed * (1.0 + ratio) * (rise - x) / x;
        let mut x = 1e-3 * rise;
        // The start of the root: x^2 / 2 = rate t.
        let mut time = x * x / (2.0 * speed * (1.0 + ratio) * rise);
        let mut curve = vec![(0.0, 0.0), (time, x)];
        while time < seconds {
            let step = (0.01 * x / rate(x).max(1e-12)).min(1e-3 * seconds);
            let k1 = rate(x);
            let k2 = rate(x + 0.5 * step * k1);
            let k3 = rate(x + 0.5 * step * k2);
            let k4 = rate(x + step * k3);
            x += step * (k1 + 2.0 * k2 + 2.0 * k3 + k4) / 6.0;
            time += step;
            curve.push((time, x));
        }
        curve
    }

    /// Permeability by a falling head \[m^2\]. The column H, the sum of the head and the thickness L of the block, decays as
    /// `exp(-a t)`.
    ///
    /// For slow water `a = K rho g / (mu L)`. Fast water adds its inertia as it slows down, and carries momentum out of the
    /// block: `rho d(q H)/dt = rho g H - mu L q / K - rho q^2 / phi` with `q = a H` is
    /// `mu L a / K = rho (g + (2 - 1 / phi) a^2 H)`.
    #[must_use]
    pub fn from_falling_head(&self, gravity: f64, thickness: f64, column: f64, decay: f64) -> f64 {
        let pressed = gravity + (2.0 - 1.0 / self.porosity) * decay * decay * column;
        decay * self.viscosity * thickness / (self.density * pressed)
    }
}

/// Drag of fast water in pores after Forchheimer: `-grad p = mu q / K + rho c q^2 / sqrt(K)`, with the volume flux q.
#[derive(Clone, Copy, Debug)]
pub struct Forchheimer {
    /// The pores.
    pub pores: Pores,
    /// Forchheimer coefficient c \[1\].
    pub coefficient: f64,
}

impl Forchheimer {
    /// Pressure gradient over the flux \[Pa s/m^2\], at a flux \[m/s\].
    #[must_use]
    pub fn drag(&self, flow: f64) -> f64 {
        let Pores { permeability, viscosity, density, .. } = self.pores;
        viscosity / permeability + density * self.coefficient * flow / permeability.sqrt()
    }

    /// Flux through a soaked block under a column of water of a height \[m/s\].
    #[must_use]
    pub fn flow(&self, gravity: f64, thickness: f64, head: f64) -> f64 {
        let gradient = self.pores.density * gravity * (head + thickness) / thickness;
        let linear = self.drag(0.0);
        let square = self.drag(1.0) - linear;
        // A form of the root that also holds without the quadratic term.
        2.0 * gradient / (linear + (linear * linear + 4.0 * square * gradient).sqrt())
    }
}

/// Root mean square distance of a curve from a reference, over the largest value of the reference in its range. The curve
/// may start `delay` later.
#[must_use]
pub fn curve_error(reference: &[(f64, f64)], curve: &[(f64, f64)], delay: f64) -> f64 {
    let expected: Vec<f64> = curve.iter().map(|point| interpolated(reference, point.0 - delay)).collect();
    let largest = expected.iter().copied().fold(0.0, f64::max);
    crate::norms::root_mean_square(curve.iter().zip(&expected).map(|(point, x)| point.1 - x)) / largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_bath_is_the_formula_with_gravity_and_a_narrow_one_is_faster() {
        let pores = Pores {
            permeability: 1e-9,
            porosity: 0.9,
            entry_pressure: 500.0,
            viscosity: 1e-3,
            density: 1000.0,
        };
        let (gravity, curve) = (9.81, pores.bath(9.81, 0.0, 8.0));
        let rise = pores.rise(gravity);
        assert!((rise - 0.05097).abs() < 1e-5);
        // t = (phi mu / (K rho g)) (-h - H ln(1 - h / H)), at the values of the table.
        for (share, time) in [(0.25, 0.176), (0.5, 0.903), (0.75, 2.975), (0.9, 6.56)] {
            let found = interpolated(&curve, time) / rise;
            assert!((found - share).abs() < 2e-3, "{time}: {found}");
        }
        let narrow = pores.bath(gravity, 0.3, 8.0);
        assert!(interpolated(&narrow, 0.903) / rise > 0.53);
        assert!((pores.front(0.584) - 0.5 * rise).abs() < 2e-4);
    }
    #[test]
    fn the_flow_of_a_head_loses_its_pressure_and_is_darcys_where_it_is_slow() {
        let pores = Pores {
            permeability: 1e-8,
            porosity: 0.9,
            entry_pressure: 0.0,
            viscosity: 1e-3,
            density: 1000.0,
        };
        let (gravity, thickness) = (9.81, 0.04);
        for head in [0.0, 0.02, 0.06] {
            let lost = |fast: &Forchheimer, coefficient| {
                let flow = fast.flow(gravity, thickness, head);
                Forchheimer { coefficient, ..*fast }.drag(flow) * flow * thickness
            };
            let fast = Forchheimer { pores, coefficient: 0.5 };
            let given = pores.density * gravity * (head + thickness);
            assert!((lost(&fast, 0.5) / given - 1.0).abs() < 1e-12);
            assert!((lost(&fast, 0.4) / given - 1.0).abs() > 0.1);
            // As the head falls without it: d(h + L)/dt = -q.
            let slow = Forchheimer { coefficient: 0.0, ..fast }.flow(gravity, thickness, head);
            let decay = slow / (head + thickness);
            let found = pores.from_falling_head(gravity, thickness, head + thickness, decay) / 1e-8;
            // The inertia of the decelerating column adds pressure: a lower permeability then has the same decay.
            let inertia = (2.0 - 1.0 / 0.9) * decay * decay * (head + thickness) / gravity;
            assert!((found * (1.0 + inertia) - 1.0).abs() < 1e-12);
            assert!((0.02..0.1).contains(&inertia));
        }
    }
}
