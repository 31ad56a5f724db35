//! Energy densities of the solvers' materials, with gradient and Hessian.

use sorb::glam::{DMat3, DVec3};

use super::outer;
use crate::solver::{Material, Solvers};

/// Energy per volume at rest as a function of the deformation gradient F with columns `f_k`, `J = det F`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Energy {
    /// The constraints of strain based dynamics: half of `M_s` times `sum (|f_k| - 1)^2`, `M_t` times `sum (f_k . f_l)^2`
    /// and `M_v` times `(J - 1)^2`. The frame is that of the lattice, up to order and sign of the axes.
    Strain {
        /// `M_s` \[Pa\].
        stretch: f64,
        /// `M_t` \[Pa\].
        shear: f64,
        /// `M_v` \[Pa\].
        volume: f64,
    },
    /// Compressible Neo-Hookean, `mu / 2 (F : F - 3) - mu ln J + l / 2 (J - 1)^2` \[BW08\], where J is at least a fifth.
    Logarithmic {
        /// mu, the shear modulus \[Pa\].
        shear: f64,
        /// l, the first Lame parameter \[Pa\].
        first: f64,
    },
    /// Stable Neo-Hookean, `mu / 2 (F : F - 3) + l / 2 (J - 1 - mu / l)^2` \[MM21\].
    NeoHookean {
        /// mu, the shear modulus \[Pa\].
        shear: f64,
        /// l, the first Lame parameter plus mu \[Pa\].
        volume: f64,
    },
}

impl Energy {
    /// The energy of a solver for a material; all are equal in the limit of small strain.
    #[must_use]
    pub fn of(material: &Material, solvers: &Solvers) -> Self {
        let (shear, first) = material.lame();
        match solvers.sponge_name().as_str() {
            // At least the minimum of scenes.
            "sbd" => Self::Strain { stretch: 2.0 * shear, shear, volume: first.max(10.0) },
            "xpbd_neo_hookean" => Self::NeoHookean { shear, volume: first + shear },
            _ => Self::Logarithmic { shear, first },
        }
    }

    /// The density \[Pa\].
    #[must_use]
    pub fn density(&self, f: &DMat3) -> f64 {
        let columns = [f.x_axis, f.y_axis, f.z_axis];
        let ratio = f.determinant();
        match *self {
            Self::Strain { stretch, shear, volume } => {
                let stretched: f64 = columns.iter().map(|c| (c.length() - 1.0).powi(2)).sum();
                let sheared: f64 = PAIRS.iter().map(|(k, l)| columns[*k].dot(columns[*l]).powi(2)).sum();
                0.5 * (stretch * stretched + shear * sheared + volume * (ratio - 1.0).powi(2))
            }
            Self::Logarithmic { shear, first } => {
                let squares: f64 = columns.iter().map(|c| c.length_squared()).sum();
                0.5 * (shear * (squares - 3.0 - 2.0 * libm::log(ratio)) + first * (ratio - 1.0).powi(2))
            }
            Self::NeoHookean { shear, volume } => {
                let squares: f64 = columns.iter().map(|c| c.length_squared()).sum();
                0.5 * (shear * (squares - 3.0) + volume * (ratio - 1.0 - shear / volume).powi(2))
            }
        }
    }

    /// Derivative by F: the first Piola stress \[Pa\].
    #[must_use]
    pub fn gradient(&self, f: &DMat3) -> DMat3 {
        let columns = [f.x_axis, f.y_axis, f.z_axis];
        let areas = areas(&columns);
        let ratio = columns[0].dot(areas[0]);
        let mut sum = [DVec3::ZERO; 3];
        let pressure = match *self {
            Self::Strain { stretch, shear, volume } => {
                for k in 0..3 {
                    let length = columns[k].length();
                    sum[k] += columns[k] * (stretch * (length - 1.0) / length);
                }
                for (k, l) in PAIRS {
                    let product = shear * columns[k].dot(columns[l]);
                    sum[k] += columns[l] * product;
                    sum[l] += columns[k] * product;
                }
                volume * (ratio - 1.0)
            }
            Self::Logarithmic { shear, first } => {
                for k in 0..3 {
                    sum[k] += columns[k] * shear;
                }
                first * (ratio - 1.0) - shear / ratio
            }
            Self::NeoHookean { shear, volume } => {
                for k in 0..3 {
                    sum[k] += columns[k] * shear;
                }
                volume * (ratio - 1.0 - shear / volume)
            }
        };
        for k in 0..3 {
            sum[k] += areas[k] * pressure;
        }
        DMat3::from_cols(sum[0], sum[1], sum[2])
    }

    /// Second derivative by the columns of F: block `[k][l]` is by `f_k` and `f_l` \[Pa\].
    #[must_use]
    pub fn hessian(&self, f: &DMat3) -> [[DMat3; 3]; 3] {
        let columns = [f.x_axis, f.y_axis, f.z_axis];
        let areas = areas(&columns);
        let ratio = columns[0].dot(areas[0]);
        let mut blocks = [[DMat3::ZERO; 3]; 3];
        let (volume, pressure) = match *self {
            Self::Strain { stretch, shear, volume } => {
                for k in 0..3 {
                    let length = columns[k].length();
                    let along = outer(columns[k], columns[k]) * (1.0 / (length * length));
                    let across = DMat3::IDENTITY - along;
                    blocks[k][k] += (along + across * (1.0 - 1.0 / length)) * stretch;
                }
                for (k, l) in PAIRS {
                    let (a, b) = (columns[k], columns[l]);
                    blocks[k][k] += outer(b, b) * shear;
                    blocks[l][l] += outer(a, a) * shear;
                    let mixed = (outer(b, a) + DMat3::IDENTITY * a.dot(b)) * shear;
                    blocks[k][l] += mixed;
                    blocks[l][k] += mixed.transpose();
                }
                (volume, volume * (ratio - 1.0))
            }
            Self::Logarithmic { shear, first } => {
                for (k, row) in blocks.iter_mut().enumerate() {
                    row[k] += DMat3::IDENTITY * shear;
                }
                (first + shear / (ratio * ratio), first * (ratio - 1.0) - shear / ratio)
            }
            Self::NeoHookean { shear, volume } => {
                for (k, row) in blocks.iter_mut().enumerate() {
                    row[k] += DMat3::IDENTITY * shear;
                }
                (volume, volume * (ratio - 1.0 - shear / volume))
            }
        };
        for k in 0..3 {
            for l in 0..3 {
                blocks[k][l] += outer(areas[k], areas[l]) * volume;
            }
            // The area of k is f_l x f_m with k, l, m in cyclic order.
            let (l, m) = ((k + 1) % 3, (k + 2) % 3);
            blocks[k][l] += cross_matrix(columns[m]) * -pressure;
            blocks[k][m] += cross_matrix(columns[l]) * pressure;
        }
        blocks
    }
}

const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// Derivatives of the determinant by the columns.
fn areas(columns: &[DVec3; 3]) -> [DVec3; 3] {
    let [a, b, c] = *columns;
    [b.cross(c), c.cross(a), a.cross(b)]
}

/// The matrix M with `M x = a cross x`.
fn cross_matrix(a: DVec3) -> DMat3 {
    DMat3::from_cols(DVec3::new(0.0, a.z, -a.y), DVec3::new(-a.z, 0.0, a.x), DVec3::new(a.y, -a.x, 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ENERGIES: [Energy; 3] = [
        Energy::Strain { stretch: 3.0, shear: 2.0, volume: 1.5 },
        Energy::NeoHookean { shear: 2.0, volume: 5.0 },
        Energy::Logarithmic { shear: 2.0, first: 3.0 },
    ];

    fn deformation() -> DMat3 {
        DMat3::from_cols(DVec3::new(1.1, 0.1, -0.2), DVec3::new(0.05, 0.9, 0.15), DVec3::new(-0.1, 0.2, 1.2))
    }

    fn moved(f: &DMat3, column: usize, axis: usize, by: f64) -> DMat3 {
        let mut f = *f;
        f.col_mut(column)[axis] += by;
        f
    }

    #[test]
    #[expect(clippy::needless_range_loop, reason = "the columns are indices of several things")]
    fn gradient_and_hessian_are_the_differences_of_the_density() {
        let (f, step) = (deformation(), 1e-5);
        for energy in ENERGIES {
            let (gradient, hessian) = (energy.gradient(&f), energy.hessian(&f));
            for k in 0..3 {
                for i in 0..3 {
                    let (up, down) = (moved(&f, k, i, step), moved(&f, k, i, -step));
                    let slope = (energy.density(&up) - energy.density(&down)) / (2.0 * step);
                    assert!((slope - gradient.col(k)[i]).abs() < 1e-8, "{energy:?} {k} {i}");
                    let difference = (energy.gradient(&up) - energy.gradient(&down)) * (0.5 / step);
                    for l in 0..3 {
                        let column = difference.col(l);
                        let expected = DVec3::new(
                            hessian[l][k].row(0)[i],
                            hessian[l][k].row(1)[i],
                            hessian[l][k].row(2)[i],
                        );
                        assert!((column - expected).length() < 1e-7, "{energy:?} {k} {i} {l}");
                    }
                }
            }
        }
    }

    #[test]
    fn all_energies_are_the_same_material_at_small_strain() {
        let material = Material { young: 2e4, poisson: 0.2, density: 50.0 };
        let of = |name: &str| {
            Energy::of(&material, &Solvers { sponge: Some(name.to_owned()), ..Solvers::default() })
        };
        let paper = of("sbd");
        let strain = DMat3::from_cols(
            DVec3::new(1.0, 0.4, -0.2),
            DVec3::new(0.4, -0.3, 0.5),
            DVec3::new(-0.2, 0.5, 0.7),
        );
        let stress = |energy: &Energy, size: f64| {
            (energy.gradient(&(DMat3::IDENTITY + strain * size)) - energy.gradient(&DMat3::IDENTITY))
                * (1.0 / size)
        };
        let size = |matrix: DMat3| matrix.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
        for other in [of("vbd"), of("xpbd_neo_hookean")] {
            let difference = stress(&paper, 1e-6) - stress(&other, 1e-6);
            assert!(size(difference) < 1e-4 * size(stress(&paper, 1e-6)), "{other:?}");
            // Negative control: at large strain they differ.
            let difference = stress(&paper, 0.3) - stress(&other, 0.3);
            assert!(size(difference) > 0.05 * size(stress(&paper, 0.3)), "{other:?}");
        }
    }
}
