//! An order of bytes that lz4 packs well.
//!
//! Neighbouring rows are near each other in space: a word combined with that of the row before (exclusive or) begins with
//! zeros. The first bytes of all words follow each other, then the second ones, and so on.

/// Bytes of a row of a section, from its name; none for what is not a list of rows.
pub(super) fn row_bytes(name: &str) -> Option<usize> {
    let column = super::body::saved_columns().find(|column| column.name() == name);
    match column {
        Some(column) => Some(column.element().bytes()).filter(|bytes| *bytes > 0),
        None => super::body::SLEEP.contains(&name).then_some(12),
    }
}

/// Orders a list of rows.
pub(super) fn apply(bytes: &[u8], row: usize, out: &mut Vec<u8>) {
    let rows = bytes.len() / row;
    for plane in (0..row).map(planes(row)) {
        let mut before = 0;
        for index in 0..rows {
            let own = bytes[index * row + plane];
            out.push(own ^ before);
            before = own;
        }
    }
    out.extend_from_slice(&bytes[rows * row..]);
}

/// The opposite of [`apply`].
pub(super) fn undo(bytes: &mut [u8], row: usize) {
    let rows = bytes.len() / row;
    let mut all = vec![0; rows * row];
    for (plane, ordered) in (0..row).map(planes(row)).zip(bytes.chunks_exact(rows.max(1))) {
        let mut before = 0;
        for (index, byte) in ordered.iter().enumerate() {
            before ^= byte;
            all[index * row + plane] = before;
        }
    }
    bytes[..rows * row].copy_from_slice(&all);
}

/// The bytes of a row: the last of all its words, which have the exponents, come first.
fn planes(row: usize) -> impl Fn(usize) -> usize {
    move |index| {
        let words = row / 4;
        (index % words) * 4 + 3 - index / words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_is_undone_and_near_rows_become_zeros() {
        for row in [4, 12, 16] {
            let bytes: Vec<u8> = (0..row as u32 * 50 + 3).map(|index| (index * 31 % 251) as u8).collect();
            let mut ordered = Vec::new();
            apply(&bytes, row, &mut ordered);
            assert_ne!(ordered, bytes);
            undo(&mut ordered, row);
            assert_eq!(ordered, bytes, "{row}");
        }
        let near: Vec<u8> = (0..100).flat_map(|row| (1.0_f32 + row as f32 * 1e-6).to_le_bytes()).collect();
        let mut ordered = Vec::new();
        apply(&near, 4, &mut ordered);
        assert!(ordered[1..200].iter().filter(|byte| **byte == 0).count() > 190);
    }
}
