//! Common properties of columns: lifetime, padding, and words to hash.

use crate::layout::constants;

constants! {
    /// Coordinate of padding rows \[m\]: beyond every support radius, with a square that is still finite.
    pub const FAR: f32 = 1.0e15;
}

/// A row at [`FAR`].
pub const FAR_ROW: [f32; 4] = [FAR, FAR, FAR, 0.0];

/// Number of rows to allocate for `rows` particles: a multiple of eight with at least one padding row.
#[must_use]
pub fn padded(rows: usize) -> usize {
    (rows + 8) / 8 * 8
}

/// Lifetime of the content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// Survives a step; part of every digest and of a saved state.
    State,
    /// Rebuilt in steps that have work for it, and kept in others, while a part of the scene sleeps. No kernel reads it before
    /// it is written; measures and pictures do. Part of a saved state.
    Kept,
    /// Set up with the scene and changed by commands of the host only. Part of a saved state.
    Commanded,
    /// Set up with the scene and never changed.
    Constant,
    /// Rebuilt in every step; never read before it is written.
    Scratch,
}

impl Life {
    /// Whether a step writes the column before it reads it.
    #[must_use]
    pub const fn is_rebuilt(self) -> bool {
        matches!(self, Self::Scratch | Self::Kept)
    }

    /// Whether a saved state holds the column.
    #[must_use]
    pub const fn is_saved(self) -> bool {
        matches!(self, Self::State | Self::Kept | Self::Commanded)
    }
}

/// A number in the rows of a column of four floats, or a vector in the first three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lane {
    /// Name; empty for the vector.
    pub name: &'static str,
    /// First float.
    pub index: usize,
    /// SI unit.
    pub unit: &'static str,
}

/// Content of a row of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Element {
    /// Four floats: their lanes.
    Rows(&'static [Lane]),
    /// A float of this unit.
    Values(&'static str),
    /// A word of this unit.
    Words(&'static str),
    /// Another type.
    Other,
}

impl Element {
    /// Bytes of a row of a plain array, 0 for other types.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Rows(_) => 16,
            Self::Values(_) | Self::Words(_) => 4,
            Self::Other => 0,
        }
    }

    /// Whether the first three floats of a row are a vector.
    #[must_use]
    pub fn has_vector(self) -> bool {
        matches!(self, Self::Rows(lanes) if lanes.first().is_some_and(|lane| lane.name.is_empty()))
    }
}

/// Content of padding rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Padding {
    /// Zeros.
    Zero,
    /// This row.
    Row([f32; 4]),
    /// This word.
    Word(u32),
}

impl Padding {
    /// The row.
    #[must_use]
    pub const fn row(self) -> [f32; 4] {
        if let Self::Row(row) = self { row } else { [0.0; 4] }
    }

    /// The word.
    #[must_use]
    pub const fn word(self) -> u32 {
        if let Self::Word(word) = self { word } else { 0 }
    }
}

/// The data of a column that is a plain array.
#[derive(Debug)]
pub enum Plain<'a> {
    /// Four floats a row.
    Rows(&'a Vec<[f32; 4]>),
    /// A float a row.
    Values(&'a Vec<f32>),
    /// A word a row.
    Words(&'a Vec<u32>),
}

/// The same, writable.
#[derive(Debug)]
pub enum PlainMut<'a> {
    /// Four floats a row.
    Rows(&'a mut Vec<[f32; 4]>),
    /// A float a row.
    Values(&'a mut Vec<f32>),
    /// A word a row.
    Words(&'a mut Vec<u32>),
}

/// The words of a column, which saved files, digests, comparisons and transfers to a device share.
pub trait ColumnData {
    /// Calls `visit` with every 32-bit word of the first `rows` rows, in order.
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32));
    /// Takes over what [`Self::visit_words`] gave of as many rows. False where there are more or fewer words than the column has: then
    /// nothing is changed. Always false for lists, cells and the lattice, which are computed from other columns.
    fn take_words(&mut self, rows: usize, words: &[u32]) -> bool {
        let _ = (rows, words);
        false
    }
    /// Overwrites everything with values that are noticed when a kernel reads them.
    fn poison(&mut self);
    /// The array, if it is a plain one.
    fn plain(&self) -> Option<Plain<'_>> {
        None
    }
    /// The array, writable, if it is a plain one.
    fn plain_mut(&mut self) -> Option<PlainMut<'_>> {
        None
    }
}

/// The bits of every NaN in digests and files. Its sign and payload depend on the machine, and WebAssembly leaves them open.
const NOT_A_NUMBER: u32 = 0x7FC0_0000;

/// The bits of a float, the same for every NaN.
#[must_use]
pub fn bits(value: f32) -> u32 {
    if value.is_nan() { NOT_A_NUMBER } else { value.to_bits() }
}

/// Takes over the words of the first rows, `width` words each, if there are as many; the padding stays.
pub(crate) fn take_rows<T>(
    data: &mut [T],
    rows: usize,
    words: &[u32],
    width: usize,
    take: impl Fn(&mut T, &[u32]),
) -> bool {
    let own = data.iter_mut().take(rows);
    let fits = own.len() * width == words.len();
    if fits {
        own.zip(words.chunks_exact(width)).for_each(|(own, words)| take(own, words));
    }
    fits
}

impl ColumnData for Vec<f32> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).for_each(|value| visit(bits(*value)));
    }
    fn take_words(&mut self, rows: usize, words: &[u32]) -> bool {
        take_rows(self, rows, words, 1, |own, words| *own = f32::from_bits(words[0]))
    }
    fn poison(&mut self) {
        self.fill(f32::NAN);
    }
    fn plain(&self) -> Option<Plain<'_>> {
        Some(Plain::Values(self))
    }
    fn plain_mut(&mut self) -> Option<PlainMut<'_>> {
        Some(PlainMut::Values(self))
    }
}

impl ColumnData for Vec<[f32; 4]> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).flatten().for_each(|value| visit(bits(*value)));
    }
    fn take_words(&mut self, rows: usize, words: &[u32]) -> bool {
        take_rows(self, rows, words, 4, |own, words| {
            own.iter_mut().zip(words).for_each(|(own, word)| *own = f32::from_bits(*word));
        })
    }
    fn poison(&mut self) {
        self.fill([f32::NAN; 4]);
    }
    fn plain(&self) -> Option<Plain<'_>> {
        Some(Plain::Rows(self))
    }
    fn plain_mut(&mut self) -> Option<PlainMut<'_>> {
        Some(PlainMut::Rows(self))
    }
}

impl ColumnData for Vec<u32> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).for_each(|value| visit(*value));
    }
    fn take_words(&mut self, rows: usize, words: &[u32]) -> bool {
        take_rows(self, rows, words, 1, |own, words| *own = words[0])
    }
    fn poison(&mut self) {
        self.fill(u32::MAX);
    }
    fn plain(&self) -> Option<Plain<'_>> {
        Some(Plain::Words(self))
    }
    fn plain_mut(&mut self) -> Option<PlainMut<'_>> {
        Some(PlainMut::Words(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn padding_always_leaves_a_spare_row() {
        for rows in 0..100 {
            assert!(padded(rows) > rows && padded(rows).is_multiple_of(8) && padded(rows) <= rows + 8);
        }
    }
}
