//! The sparse stiffness matrix of the free coordinates.

use faer::{
    Col, Side,
    prelude::Solve,
    sparse::{SparseColMat, Triplet, linalg::solvers::Llt},
};
use sorb::glam::DVec3;

use super::{Model, failure};
use crate::case::Failure;

/// Numbers of the free coordinates: `of[node][axis]`.
pub(super) struct Freedoms {
    of: Vec<[Option<usize>; 3]>,
    pub(super) count: usize,
}

impl Freedoms {
    pub(super) fn new(model: &Model) -> Self {
        let mut count = 0;
        let number = |held: &[bool; 3]| {
            held.map(|held| {
                (!held).then(|| {
                    count += 1;
                    count - 1
                })
            })
        };
        let of = model.held.iter().map(number).collect();
        Self { of, count }
    }

    /// The free coordinates of vectors at the nodes.
    pub(super) fn gather(&self, vectors: &[DVec3]) -> Vec<f64> {
        let mut values = vec![0.0; self.count];
        for (vector, freedoms) in vectors.iter().zip(&self.of) {
            for axis in 0..3 {
                if let Some(freedom) = freedoms[axis] {
                    values[freedom] = vector[axis];
                }
            }
        }
        values
    }

    /// Adds values times a factor to the free coordinates of vectors.
    pub(super) fn add(&self, values: &[f64], factor: f64, vectors: &mut [DVec3]) {
        for (vector, freedoms) in vectors.iter_mut().zip(&self.of) {
            for axis in 0..3 {
                if let Some(freedom) = freedoms[axis] {
                    vector[axis] += factor * values[freedom];
                }
            }
        }
    }
}

/// A factorised matrix.
pub(super) struct Factors(Llt<usize, f64>);

impl Factors {
    /// Stiffness at given positions plus `shift` times the identity; none if it is not positive definite.
    pub(super) fn new(
        model: &Model,
        freedoms: &Freedoms,
        positions: &[DVec3],
        shift: f64,
    ) -> Result<Option<Self>, Failure> {
        let mut entries = Vec::with_capacity(model.tets.len() * 144 + freedoms.count);
        for (index, tet) in model.tets.iter().enumerate() {
            let hessian = model.energy.hessian(&model.deformation(index, positions));
            let (shapes, volume) = (&model.shapes[index], model.volumes[index]);
            for (v, a) in tet.iter().enumerate() {
                for (w, b) in tet.iter().enumerate() {
                    let mut block = sorb::glam::DMat3::ZERO;
                    for (k, row) in hessian.iter().enumerate() {
                        for (l, part) in row.iter().enumerate() {
                            block += *part * (volume * shapes[v][k] * shapes[w][l]);
                        }
                    }
                    for i in 0..3 {
                        for j in 0..3 {
                            if let (Some(row), Some(column)) = (freedoms.of[*a][i], freedoms.of[*b][j])
                                && row >= column
                            {
                                entries.push(Triplet::new(row, column, block.col(j)[i]));
                            }
                        }
                    }
                }
            }
        }
        entries.extend((0..freedoms.count).map(|freedom| Triplet::new(freedom, freedom, shift)));
        let matrix = SparseColMat::try_new_from_triplets(freedoms.count, freedoms.count, &entries)
            .map_err(|error| failure(format!("stiffness: {error:?}")))?;
        Ok(matrix.sp_cholesky(Side::Lower).ok().map(Self))
    }

    pub(super) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let right = Col::from_fn(right.len(), |row| right[row]);
        let solution = self.0.solve(&right);
        (0..right.nrows()).map(|row| solution[row]).collect()
    }
}
