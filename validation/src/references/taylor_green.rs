//! One cell of the decaying vortices of G. I. Taylor and A. E. Green (Proc. R. Soc. A 158 (1937) 499).
//!
//! In a square between free-slip walls, `0 <= x, y <= L`, the velocity
//! `U (sin(pi x / L) cos(pi y / L), -cos(pi x / L) sin(pi y / L)) exp(-2 nu (pi / L)^2 t)` solves the Navier-Stokes
//! equations. Its advection is a gradient, which the pressure balances.

use std::f64::consts::PI;

/// A vortex.
#[derive(Clone, Copy, Debug)]
pub struct Vortex {
    /// Side of the square \[m\].
    pub side: f64,
    /// Largest speed at time zero \[m/s\].
    pub speed: f64,
    /// Kinematic viscosity \[m^2/s\].
    pub viscosity: f64,
}

impl Vortex {
    /// Velocity at a point of the square and a time \[m/s\].
    #[must_use]
    pub fn velocity(&self, [x, y]: [f64; 2], time: f64) -> [f64; 2] {
        let (x, y) = (PI * x / self.side, PI * y / self.side);
        let size = self.speed * libm::exp(-self.rate() * time);
        [size * libm::sin(x) * libm::cos(y), -size * libm::cos(x) * libm::sin(y)]
    }

    /// Rate at which every velocity decays, `2 nu (pi / L)^2` \[1/s\]; that of the kinetic energy is twice as high.
    #[must_use]
    pub fn rate(&self) -> f64 {
        2.0 * self.viscosity * (PI / self.side).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vorticity by central differences.
    fn vorticity(vortex: &Vortex, [x, y]: [f64; 2], time: f64) -> f64 {
        let h = 1e-4;
        let v = |x, y| vortex.velocity([x, y], time);
        (v(x + h, y)[1] - v(x - h, y)[1] - v(x, y + h)[0] + v(x, y - h)[0]) / (2.0 * h)
    }

    /// Largest error of the equation of vorticity, `dw/dt + u . grad w = nu lap w`, if velocities fall at `factor` times the
    /// rate.
    fn residual(vortex: &Vortex, factor: f64) -> f64 {
        let h = 1e-3;
        let points = (1..8).flat_map(|x| (1..8).map(move |y| [f64::from(x) / 8.0, f64::from(y) / 8.0]));
        let errors = points.map(|[x, y]| {
            let w = |x, y, t: f64| vorticity(vortex, [x, y], factor * t);
            let [u, v] = vortex.velocity([x, y], 0.0);
            let change = (w(x, y, h) - w(x, y, -h)) / (2.0 * h);
            let [east, west] = [w(x + h, y, 0.0), w(x - h, y, 0.0)];
            let [north, south] = [w(x, y + h, 0.0), w(x, y - h, 0.0)];
            let spread = (east + west + north + south - 4.0 * w(x, y, 0.0)) / (h * h);
            (change + (u * (east - west) + v * (north - south)) / (2.0 * h) - vortex.viscosity * spread).abs()
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn it_solves_the_equation_of_vorticity_and_another_rate_does_not() {
        let vortex = Vortex { side: 1.0, speed: 1.0, viscosity: 0.01 };
        assert!(residual(&vortex, 1.0) < 1e-3, "{}", residual(&vortex, 1.0));
        assert!(residual(&vortex, 1.1) > 0.05, "{}", residual(&vortex, 1.1));
    }

    #[test]
    fn nothing_flows_through_the_walls_or_comes_from_nowhere() {
        let vortex = Vortex { side: 2.0, speed: 3.0, viscosity: 0.1 };
        for along in [0.1, 0.7, 1.9] {
            for wall in [0.0, 2.0] {
                assert!(vortex.velocity([wall, along], 0.5)[0].abs() < 1e-12);
                assert!(vortex.velocity([along, wall], 0.5)[1].abs() < 1e-12);
            }
            let h = 1e-4;
            let v = |x, y| vortex.velocity([x, y], 0.5);
            let (x, y) = (along, 0.3);
            let divergence = (v(x + h, y)[0] - v(x - h, y)[0] + v(x, y + h)[1] - v(x, y - h)[1]) / (2.0 * h);
            assert!(divergence.abs() < 1e-6, "{divergence}");
            assert!(((v(x + h, y)[0] - v(x - h, y)[0]) / (2.0 * h)).abs() > 0.1, "no flow to speak of");
        }
    }
}
