//! Potential flow around solids in a tank, by finite volumes whose faces are partly open: added mass and inertance.
//!
//! ```text
//! sum over faces of a_f A (phi_n - phi) / h = q,   phi given at free surfaces
//! ```
//!
//! `a_f` is the part of a face that is outside of the solid. The open faces of a cell and the surface of the solid in it close. What moves
//! at the speed U along y therefore pushes `q = U A (a_top - a_bottom)` out of a cell. Second order in the size of the cells.

/// A tank of equal cubes; faces without a neighbour are walls.
#[derive(Clone, Debug)]
pub struct Tank {
    counts: [usize; 3],
    size: f64,
    /// Open part of the faces towards larger x, y, z, of every cell.
    open: [Vec<f64>; 3],
    /// Potential at the upper face of cells that have a free surface there.
    surface: Vec<Option<f64>>,
}

/// Points along each side of a face at which it is seen whether that is open.
const SAMPLES: usize = 8;
/// Residual of a solve over that at first.
const TOLERANCE: f64 = 1e-9;

impl Tank {
    /// A tank of so many cells \[m\] that begins at the origin, without the points that are solid.
    #[must_use]
    pub fn new(counts: [usize; 3], size: f64, is_solid: impl Fn([f64; 3]) -> bool) -> Self {
        let total: usize = counts.iter().product();
        let mut tank = Self {
            counts,
            size,
            open: [vec![0.0; total], vec![0.0; total], vec![0.0; total]],
            surface: vec![None; total],
        };
        for cell in 0..total {
            let at = tank.place(cell);
            for axis in 0..3 {
                // The upper face of the uppermost cells is there for a free surface.
                if at[axis] + 1 < counts[axis] || axis == 1 {
                    tank.open[axis][cell] = tank.open_part(at, axis, &is_solid);
                }
            }
        }
        tank
    }

    /// Gives the water a free surface at the upper faces of the cells of a height, with a potential for every place along x.
    #[must_use]
    pub fn with_surface(mut self, row: usize, potential: impl Fn(f64) -> Option<f64>) -> Self {
        for cell in 0..self.surface.len() {
            let at = self.place(cell);
            if at[1] == row {
                self.surface[cell] = potential((at[0] as f64 + 0.5) * self.size);
            }
            if at[1] > row {
                (0..3).for_each(|axis| self.open[axis][cell] = 0.0);
            } else if at[1] == row && self.surface[cell].is_none() {
                self.open[1][cell] = 0.0;
            }
        }
        self
    }

    /// Added mass over the density for the solid's motion along y \[m^3\]: `integral of phi n_y dA` at a speed of 1.
    #[must_use]
    pub fn added_volume(&self) -> f64 {
        let pushed: Vec<f64> = (0..self.surface.len()).map(|cell| self.pushed(cell)).collect();
        let potential = self.solved(&pushed);
        potential.iter().zip(&pushed).map(|(phi, pushed)| phi * pushed).sum()
    }

    /// Volume that flows in a unit of time into the surfaces of a potential, for the given potentials of the surfaces \[m^3/s\].
    #[must_use]
    pub fn flow(&self, into: f64) -> f64 {
        let potential = self.solved(&vec![0.0; self.surface.len()]);
        let through = |(cell, surface): (usize, &Option<f64>)| {
            surface
                .filter(|own| *own == into)
                .map_or(0.0, |own| 2.0 * self.size * self.open[1][cell] * (own - potential[cell]))
        };
        self.surface.iter().enumerate().map(through).sum()
    }

    fn place(&self, cell: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [cell % nx, cell / nx % ny, cell / nx / ny]
    }

    /// Cells between one cell and the next along an axis.
    fn stride(&self, axis: usize) -> usize {
        self.counts[..axis].iter().product()
    }

    fn open_part(&self, at: [usize; 3], axis: usize, is_solid: &impl Fn([f64; 3]) -> bool) -> f64 {
        let mut open = 0;
        for (i, j) in (0..SAMPLES).flat_map(|i| (0..SAMPLES).map(move |j| (i, j))) {
            let within = |index: usize| (index as f64 + 0.5) / SAMPLES as f64;
            let mut point = [0.0; 3];
            point[axis] = (at[axis] + 1) as f64;
            point[(axis + 1) % 3] = at[(axis + 1) % 3] as f64 + within(i);
            point[(axis + 2) % 3] = at[(axis + 2) % 3] as f64 + within(j);
            open += usize::from(!is_solid(point.map(|x| x * self.size)));
        }
        open as f64 / (SAMPLES * SAMPLES) as f64
    }

    /// What a solid that moves along y at a speed of 1 pushes out of a cell \[m^3/s\].
    fn pushed(&self, cell: usize) -> f64 {
        let below = if self.place(cell)[1] == 0 { 1.0 } else { self.open[1][cell - self.stride(1)] };
        let above = if self.place(cell)[1] + 1 == self.counts[1] { 1.0 } else { self.open[1][cell] };
        // At the floor and at a surface there is no solid.
        self.size * self.size * if self.surface[cell].is_some() { 0.0 } else { above - below }
    }

    /// Applies the operator, for surfaces whose potential is zero.
    fn applied(&self, phi: &[f64], result: &mut [f64]) {
        result.fill(0.0);
        for cell in 0..phi.len() {
            for (axis, place) in self.place(cell).into_iter().enumerate() {
                let part = self.open[axis][cell] * self.size;
                if part > 0.0 && place + 1 < self.counts[axis] && (axis != 1 || self.surface[cell].is_none())
                {
                    let next = cell + self.stride(axis);
                    let flow = part * (phi[next] - phi[cell]);
                    result[cell] -= flow;
                    result[next] += flow;
                }
            }
            if self.surface[cell].is_some() {
                result[cell] += 2.0 * self.open[1][cell] * self.size * phi[cell];
            }
        }
    }

    /// The potential, by conjugate gradients with the diagonal: `operator phi = pushed`, with the surfaces' own potentials.
    fn solved(&self, pushed: &[f64]) -> Vec<f64> {
        let count = pushed.len();
        let mut residual: Vec<f64> = (0..count)
            .map(|cell| {
                pushed[cell]
                    + self.surface[cell].map_or(0.0, |own| 2.0 * self.open[1][cell] * self.size * own)
            })
            .collect();
        let diagonal = self.diagonal();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let scaled = |residual: &[f64]| -> Vec<f64> {
            residual.iter().zip(&diagonal).map(|(r, d)| if *d > 0.0 { r / d } else { 0.0 }).collect()
        };
        let (mut phi, mut image) = (vec![0.0; count], vec![0.0; count]);
        let mut direction = scaled(&residual);
        let mut square = product(&residual, &direction);
        let first = square;
        for _ in 0..10 * count {
            if square <= TOLERANCE * TOLERANCE * first {
                break;
            }
            self.applied(&direction, &mut image);
            let length = square / product(&direction, &image);
            for cell in 0..count {
                phi[cell] += length * direction[cell];
                residual[cell] -= length * image[cell];
            }
            let next = scaled(&residual);
            let after = product(&residual, &next);
            for (direction, next) in direction.iter_mut().zip(&next) {
                *direction = next + after / square * *direction;
            }
            square = after;
        }
        phi
    }

    fn diagonal(&self) -> Vec<f64> {
        let mut diagonal = vec![0.0; self.surface.len()];
        for cell in 0..diagonal.len() {
            for (axis, place) in self.place(cell).into_iter().enumerate() {
                let part = self.open[axis][cell] * self.size;
                if part > 0.0 && place + 1 < self.counts[axis] && (axis != 1 || self.surface[cell].is_none())
                {
                    diagonal[cell] += part;
                    diagonal[cell + self.stride(axis)] += part;
                }
            }
            if self.surface[cell].is_some() {
                diagonal[cell] += 2.0 * self.open[1][cell] * self.size;
            }
        }
        diagonal
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter of a tank with a body in its axis.
    fn quarter(cells: usize, height: usize, is_solid: impl Fn([f64; 3]) -> bool) -> f64 {
        let tank = Tank::new([cells, height + 1, cells], 1.0 / cells as f64, is_solid);
        4.0 * tank.with_surface(height - 1, |_| Some(0.0)).added_volume()
    }

    fn sphere(radius: f64, centre: f64) -> impl Fn([f64; 3]) -> bool {
        move |[x, y, z]| x * x + (y - centre).powi(2) + z * z < radius * radius
    }

    #[test]
    fn a_small_sphere_carries_half_of_what_it_displaces() {
        // Spheres in a duct as wide as deep carry more, as the cube of their size.
        let over = |radius: f64, cells: usize| {
            quarter(cells, 2 * cells, sphere(radius, 1.0))
                / (4.0 / 3.0 * std::f64::consts::PI * radius.powi(3))
        };
        let (small, large) = (over(0.25, 32), over(0.5, 32));
        assert!((small - 0.5).abs() < 0.03, "{small}");
        assert!(large - 0.5 > 4.0 * (small - 0.5).max(0.0) && large < 0.8, "{small} {large}");
        // Cells twice as large give the same.
        assert!((over(0.5, 16) - large).abs() < 0.02 * large, "{large}");
    }

    #[test]
    fn a_floor_adds_to_it_and_a_surface_takes_away() {
        let at = |centre: f64| quarter(24, 48, sphere(0.25, centre));
        let middle = at(1.0);
        assert!(at(0.28) > 1.15 * middle && at(1.72) < 0.95 * middle, "{} {middle} {}", at(0.28), at(1.72));
    }

    #[test]
    fn a_straight_duct_has_the_inertance_of_its_length() {
        // Two shafts of a fifth of the width that a duct of the same height joins: water turns twice, and cuts corners.
        let tank = |block: f64| {
            let solid = move |[x, y, _]: [f64; 3]| (x - 0.5).abs() < block && y > 0.2;
            let tank = Tank::new([50, 31, 1], 0.02, solid);
            tank.with_surface(29, |x| if x < 0.2 { Some(1.0) } else { (x > 0.8).then_some(0.0) })
        };
        let flow = tank(0.3).flow(0.0).abs();
        // Along the middle 0.5 + 0.8 + 0.5 over a width of 0.2, in a slice of 0.02.
        let straight = 0.2 * 0.02 / 1.8;
        assert!(flow > straight && flow < 1.2 * straight, "{flow} {straight}");
        // Without the block between the shafts more flows.
        assert!(tank(0.0).flow(0.0).abs() > 1.3 * flow);
    }
}
