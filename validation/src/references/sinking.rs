//! Bodies that sink or rise in a tank: weight, buoyancy, added mass and drag.
//!
//! ```text
//! (s + c(y)) y'' + c'(y) y'^2 / 2 = (1 - s) g - D y' |y'|,   D = C_D A K / (2 V)
//! ```
//!
//! with the density s over that of water and the added mass c over that of what is displaced. The added mass depends on the height
//! between floor and surface ([`Tank`], the surface free). The drag is that of a body in open water, at the speed between it and the
//! walls: `K = 1 / (1 - A / A_tank)^2`.

use super::potential::Tank;
use crate::norms::{first_crossing, interpolated};

/// Shape of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A sphere of a radius \[m\].
    Sphere(f64),
    /// An upright cuboid of half extents \[m\].
    Cuboid([f64; 3]),
}

/// A body in the middle of a tank.
#[derive(Clone, Copy, Debug)]
pub struct Setup {
    /// Its shape.
    pub shape: Shape,
    /// Width of the square tank \[m\].
    pub width: f64,
    /// Depth of the water \[m\].
    pub depth: f64,
    /// Gravity \[m/s^2\].
    pub gravity: f64,
    /// Kinematic viscosity \[m^2/s\].
    pub viscosity: f64,
}

/// Cells over half of the tank for the added mass.
const CELLS: usize = 20;
/// Heights at which the added mass is computed.
const HEIGHTS: usize = 7;
/// Step of the integration \[s\].
const STEP: f64 = 2e-4;

impl Shape {
    /// Half of the height \[m\].
    #[must_use]
    pub fn half_height(self) -> f64 {
        match self {
            Self::Sphere(radius) => radius,
            Self::Cuboid(half) => half[1],
        }
    }

    fn volume(self) -> f64 {
        match self {
            Self::Sphere(radius) => 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3),
            Self::Cuboid([x, y, z]) => 8.0 * x * y * z,
        }
    }

    /// Area across the motion \[m^2\].
    fn area(self) -> f64 {
        match self {
            Self::Sphere(radius) => std::f64::consts::PI * radius * radius,
            Self::Cuboid([x, _, z]) => 4.0 * x * z,
        }
    }

    fn holds(self, [x, y, z]: [f64; 3]) -> bool {
        match self {
            Self::Sphere(radius) => x * x + y * y + z * z < radius * radius,
            Self::Cuboid(half) => x.abs() < half[0] && y.abs() < half[1] && z.abs() < half[2],
        }
    }

    /// Drag coefficient at a Reynolds number: spheres by Clift and Gauvin (1971), 1.05 for cuboids, whose edges fix where the flow
    /// comes off.
    fn drag(self, reynolds: f64) -> f64 {
        match self {
            Self::Sphere(_) => {
                let viscous = 24.0 / reynolds * (1.0 + 0.15 * libm::pow(reynolds, 0.687));
                viscous + 0.42 / (1.0 + 42_500.0 * libm::pow(reynolds, -1.16))
            }
            Self::Cuboid(_) => 1.05,
        }
    }
}

/// A path: times \[s\] and heights of the centre \[m\].
#[derive(Clone, Debug)]
pub struct Path(Vec<(f64, f64)>);

impl Path {
    /// Height at a time \[m\].
    #[must_use]
    pub fn height(&self, time: f64) -> f64 {
        interpolated(&self.0, time)
    }

    /// When it passes a height; not a number if it does not.
    #[must_use]
    pub fn time_at(&self, height: f64) -> f64 {
        first_crossing(&self.0, height).unwrap_or(f64::NAN)
    }
}

impl Setup {
    /// Added mass over that of what is displaced, by height of the centre \[m\].
    #[must_use]
    pub fn added_mass(&self) -> Vec<(f64, f64)> {
        let size = 0.5 * self.width / CELLS as f64;
        let rows = (self.depth / size).round() as usize;
        let (low, high) = (self.shape.half_height(), self.depth - self.shape.half_height());
        (0..HEIGHTS)
            .map(|index| {
                // A cell away from floor and surface at least.
                let share = index as f64 / (HEIGHTS - 1) as f64;
                let centre = low + size + (high - low - 2.0 * size) * share;
                let shape = self.shape;
                let tank =
                    Tank::new([CELLS, rows + 1, CELLS], size, |[x, y, z]| shape.holds([x, y - centre, z]));
                let volume = 4.0 * tank.with_surface(rows - 1, |_| Some(0.0)).added_volume();
                (centre, volume / shape.volume())
            })
            .collect()
    }

    /// The path of a body from rest at a height until it is at the floor or the surface. The density of the body is over that of water.
    #[must_use]
    pub fn path(&self, density: f64, start: f64, added: &[(f64, f64)]) -> Path {
        let (half, area) = (self.shape.half_height(), self.shape.area());
        let blocked = 1.0 / (1.0 - area / (self.width * self.width)).powi(2);
        let acceleration = |y: f64, v: f64| {
            let at = |y: f64| interpolated(added, y);
            let slope = (at(y + 1e-4) - at(y - 1e-4)) / 2e-4;
            let reynolds = (v.abs() * 2.0 * half / self.viscosity).max(1e-3);
            let drag = 0.5 * self.shape.drag(reynolds) * area * blocked / self.shape.volume();
            ((1.0 - density) * self.gravity - drag * v * v.abs() - 0.5 * slope * v * v) / (density + at(y))
        };
        let (mut y, mut v, mut path) = (start, 0.0, vec![(0.0, start)]);
        while y > half && y < self.depth - half && path.len() < 100_000 {
            // Midpoint rule.
            let (middle, speed) = (y + 0.5 * STEP * v, v + 0.5 * STEP * acceleration(y, v));
            v += STEP * acceleration(middle, speed);
            y += STEP * speed;
            path.push((path.len() as f64 * STEP, y));
        }
        Path(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setup(shape: Shape, width: f64, viscosity: f64) -> Setup {
        Setup { shape, width, depth: 1.2 * width, gravity: 9.81, viscosity }
    }

    #[test]
    fn a_sphere_falls_by_half_of_its_mass_more_and_then_at_a_steady_speed() {
        let thin = setup(Shape::Sphere(0.01), 0.1, 1e-6);
        let added = [(0.0, 0.5), (1.0, 0.5)];
        let path = thin.path(1.5, 0.1, &added);
        let expected = 0.1 - 0.5 * (0.5 * 9.81 / 2.0) * 0.02_f64.powi(2);
        assert!((path.height(0.02) - expected).abs() < 1e-6, "{}", path.height(0.02));
        // In syrup, Stokes: w = (s - 1) g d^2 / (18 nu); the curve of the drag is 15 % of Re^0.687 above it.
        let thick = setup(Shape::Sphere(0.001), 0.1, 1e-3);
        let path = thick.path(1.5, 0.1, &added);
        let stokes = 0.5 * 9.81 * 0.002_f64.powi(2) / (18.0 * 1e-3);
        let speed = (path.height(1.0) - path.height(2.0)) / 1.0;
        assert!((speed / stokes - 1.0).abs() < 0.03, "{speed} {stokes}");
        assert!((path.time_at(path.height(1.5)) - 1.5).abs() < 1e-3);
    }

    #[test]
    fn added_mass_grows_towards_the_floor_and_falls_towards_the_surface() {
        for (shape, least, most) in [
            (Shape::Sphere(0.03), 0.5, 0.65),
            // A cube in open water: 0.67 (DNV-RP-C205, appendix D).
            (Shape::Cuboid([0.02; 3]), 0.64, 0.78),
        ] {
            let added = setup(shape, 0.15, 1e-6).added_mass();
            let middle = interpolated(&added, 0.09);
            assert!(middle > least && middle < most, "{shape:?}: {middle}");
            assert!(added[0].1 > 1.1 * middle && added[added.len() - 1].1 < middle, "{added:?}");
        }
    }
}
