//! What every column has: a life, padding, and words to hash.

/// Coordinate of padding rows \[m\]: beyond every support radius, with a square that is still finite.
pub const FAR: f32 = 1.0e15;

/// A row at [`FAR`].
pub const FAR_ROW: [f32; 4] = [FAR, FAR, FAR, 0.0];

/// Number of rows to allocate for `rows` particles: a multiple of eight with at least one padding row.
#[must_use]
pub fn padded(rows: usize) -> usize {
    (rows + 8) / 8 * 8
}

/// How long the content of a column lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Life {
    /// Survives a step; part of the digest and of a saved state.
    State,
    /// Set up with the scene and never written by a kernel.
    Constant,
    /// Rebuilt in every step; never read before it is written.
    Scratch,
}

/// What a column must offer to be hashed, and to be audited by the tests.
pub trait ColumnData {
    /// Calls `visit` with every 32-bit word of the first `rows` rows, in order.
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32));
    /// Overwrites everything with values that no kernel can read without being noticed.
    fn poison(&mut self);
}

impl ColumnData for Vec<f32> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        self.fill(f32::NAN);
    }
}

impl ColumnData for Vec<[f32; 4]> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).flatten().for_each(|value| visit(value.to_bits()));
    }
    fn poison(&mut self) {
        self.fill([f32::NAN; 4]);
    }
}

impl ColumnData for Vec<u32> {
    fn visit_words(&self, rows: usize, visit: &mut dyn FnMut(u32)) {
        self.iter().take(rows).for_each(|value| visit(*value));
    }
    fn poison(&mut self) {
        self.fill(u32::MAX);
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
