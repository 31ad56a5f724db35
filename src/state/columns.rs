//! Columns from little-endian bytes.

use sorb_kernels::{
    column::PlainMut,
    columns::{Column, Columns},
};

/// Reads as many words as there are.
pub(super) fn copy_words(bytes: &[u8], words: &mut [u32]) {
    for (word, bytes) in words.iter_mut().zip(bytes.as_chunks::<4>().0) {
        *word = u32::from_le_bytes(*bytes);
    }
}

/// Whether bytes are those of a column of these rows: of all of them, or of none where the column may be absent.
#[cfg(feature = "serde")]
pub(super) fn fits(
    columns: &Columns,
    rows: sorb_kernels::columns::RowCounts,
    column: Column,
    bytes: usize,
) -> bool {
    let rows = rows.of(column.store());
    let row = column.element().bytes();
    if row == 0 {
        let mut words = 0;
        columns.data(column).visit_words(rows, &mut |_| words += 1);
        return bytes == 4 * words;
    }
    let may_lack = column.life().is_rebuilt() || column.need().is_some();
    bytes == rows * row || bytes == 0 && may_lack
}

/// Takes over a column from bytes that fit.
pub(crate) fn take_column(columns: &mut Columns, column: Column, bytes: &[u8]) {
    let rows = columns.rows.of(column.store());
    let padding = column.padding();
    let to = sorb_kernels::column::padded(rows);
    match columns.data_mut(column).plain_mut() {
        Some(PlainMut::Rows(data)) => {
            make_room(data, bytes.is_empty(), (rows, to), padding.row());
            let rows = rows.min(data.len());
            copy_words(bytes, bytemuck::cast_slice_mut(&mut data[..rows]));
        }
        Some(PlainMut::Values(data)) => {
            make_room(data, bytes.is_empty(), (rows, to), 0.0);
            let rows = rows.min(data.len());
            copy_words(bytes, bytemuck::cast_slice_mut(&mut data[..rows]));
        }
        Some(PlainMut::Words(data)) => {
            make_room(data, bytes.is_empty(), (rows, to), padding.word());
            let rows = rows.min(data.len());
            copy_words(bytes, &mut data[..rows]);
        }
        None => {
            let mut words = vec![0; bytes.len() / 4];
            copy_words(bytes, &mut words);
            columns.data_mut(column).take_words(rows, &words);
        }
    }
}

/// None where the state has no rows; else at least as many as it has.
fn make_room<T: Clone>(data: &mut Vec<T>, is_absent: bool, (rows, to): (usize, usize), padding: T) {
    if is_absent {
        data.clear();
    } else if data.len() < rows {
        data.resize(to, padding);
    }
}
