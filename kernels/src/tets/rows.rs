//! The four nodes that a particle in a sponge exchanges momentum with, and what with each.

use crate::{
    column::ColumnData,
    lanes::{self, LANES, Simd, f32x8},
    layout::constants,
    vector::{Vec3x8, plus, splat, times},
};

constants! {
    /// Corners of a tet, each with a row of shares.
    pub(crate) const TET_CORNERS: usize = 4;
    /// Lane of the weight of a corner in its shares, behind a vector.
    pub(crate) const CORNER_WEIGHT: usize = 3;
}

/// Four control rows for every particle: those of the corners of its tet, or the padding row.
#[derive(Clone, Debug, Default)]
pub struct Corners(pub(crate) Vec<[u32; TET_CORNERS]>);

/// Four floats for every corner of the tet of every particle.
#[derive(Clone, Debug, Default)]
pub struct CornerRows(pub(crate) Vec<[[f32; 4]; TET_CORNERS]>);

impl Corners {
    /// Whether none of eight particles has a tet: its corners differ.
    #[inline(always)]
    pub(super) fn are_outside(&self, row: usize) -> bool {
        self.0[row..row + LANES].iter().all(|[first, second, ..]| first == second)
    }

    /// The control rows of one corner of eight particles.
    #[inline(always)]
    pub(super) fn entry(&self, row: usize, corner: usize) -> [u32; LANES] {
        std::array::from_fn(|lane| self.0[row + lane][corner])
    }
}

impl CornerRows {
    /// The rows of one corner of eight particles.
    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S, row: usize, corner: usize) -> [f32x8<S>; 4] {
        load(simd, &self.0, row, corner)
    }
}

/// The rows of one corner of eight particles.
#[inline(always)]
pub(super) fn load<S: Simd>(
    simd: S,
    rows: &[[[f32; 4]; TET_CORNERS]],
    row: usize,
    corner: usize,
) -> [f32x8<S>; 4] {
    let entry = std::array::from_fn(|lane| (TET_CORNERS * (row + lane) + corner) as u32);
    lanes::gather_rows(simd, rows.as_flattened(), &entry)
}

/// Mean of a row of the controls of eight particles, with the weights of their corners.
#[inline(always)]
pub(super) fn mean<S: Simd>(
    simd: S,
    rows: &[[f32; 4]],
    (corners, shares): (&Corners, &CornerRows),
    row: usize,
) -> Vec3x8<S> {
    let mut sum = splat(simd, [0.0; 3]);
    for corner in 0..TET_CORNERS {
        let [x, y, z, _] = lanes::gather_rows(simd, rows, &corners.entry(row, corner));
        let [.., weight] = shares.load(simd, row, corner);
        sum = plus(sum, times([x, y, z], weight));
    }
    sum
}

impl ColumnData for Corners {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.0.iter().take(rows).flatten().for_each(|row| visit(*row));
    }
    fn poison(&mut self) {
        self.0.fill([u32::MAX; 4]);
    }
}

impl ColumnData for CornerRows {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.0.iter().take(rows).flatten().flatten().for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        self.0.fill([[f32::NAN; 4]; 4]);
    }
}
