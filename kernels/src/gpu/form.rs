//! How a device holds a column: its buffer, its bytes, and its words there and back.

use super::{
    answer::Extreme as Word,
    bodies::DeviceBody,
    capacities::{Capacities, List},
    groups::{WRENCH_FLOATS, wrench_bytes},
    image_layout,
    layout::{ROW, Value, WORD_BYTES},
    vectors::wrench,
};
use crate::{
    body::Wrench,
    column::{Plain, PlainMut, padded},
    columns::{Column, Columns, RowCounts},
    contents::Contents,
    cpu::CHUNK,
    grid::neighbors::Neighbors,
    params::Params,
    reduce::{Extreme, Extremes, Wrenches},
    sph::{pressure_solve::Solve, viscosity_solve::State as ViscositySolve},
    tets::rows::TET_CORNERS,
};

/// Particles as `sph::advect` leaves them, which the next step sorts.
pub(super) const NEXT: [(Column, &str); 3] = [
    (Column::FluidPosition, "fluid_position_next"),
    (Column::FluidVelocity, "fluid_velocity_next"),
    (Column::FluidId, "fluid_id_next"),
];

/// The form of a column on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// The rows of a plain array.
    Plain,
    /// Lists of rows.
    Lists(List),
    /// Rows of this many words.
    Wide(usize),
    /// The lists of the corners that controls are.
    Corners,
    /// Words of a buffer that fluid and nodes share.
    Extremes,
    /// State of the solve for the pressure.
    PressureSolve,
    /// State of the solve for the viscosity.
    ViscositySolve,
    /// Wrenches of every group of rows on every body.
    Wrenches,
    /// Images of the particles and their lists, in several buffers.
    Images,
    /// Bodies, which the device never changes.
    Bodies,
    /// A device computes it anew, or does without.
    Nowhere,
}

impl Form {
    /// The form of a column.
    pub(super) fn of(column: Column) -> Self {
        match column {
            _ if column.is_on_host_only() => Self::Nowhere,
            _ if column.element().bytes() > 0 => Self::Plain,
            Column::FluidNeighbors => Self::Lists(List::Neighbors),
            Column::FluidControls => Self::Lists(List::Controls),
            Column::ControlFluid => Self::Lists(List::ControlFluid),
            Column::NodePairs => Self::Lists(List::Pairs),
            Column::FluidCorners => Self::Wide(TET_CORNERS),
            Column::FluidShares => Self::Wide(TET_CORNERS * ROW),
            Column::ControlCorners => Self::Corners,
            Column::FluidExtremes | Column::NodeExtremes => Self::Extremes,
            Column::FluidPressureSolve => Self::PressureSolve,
            Column::FluidViscositySolve => Self::ViscositySolve,
            Column::BodyFluidWrenches | Column::BodyPressureWrenches | Column::BodyNodeWrenches => {
                Self::Wrenches
            }
            Column::FluidImages => Self::Images,
            Column::BodyStates => Self::Bodies,
            _ => Self::Nowhere,
        }
    }

    /// Whether one buffer of it can be read back.
    pub(super) fn returns(self) -> bool {
        !matches!(self, Self::Images | Self::Bodies | Self::Nowhere)
    }

    /// The buffer of a column; `sorted` says that the particles are in the order of this step.
    pub(super) fn buffer(self, column: Column, sorted: bool) -> &'static str {
        let next = NEXT.iter().find(|(next, _)| *next == column && !sorted);
        match (self, next) {
            (Self::Extremes, _) => "extremes",
            (_, Some((_, name))) => name,
            (_, None) => column.buffer(),
        }
    }

    /// Bytes that the device holds of a column with rows, with lists of these capacities.
    pub(super) fn bytes(self, column: Column, rows: RowCounts, capacities: Capacities) -> usize {
        let count = rows.of(column.store());
        match self {
            Self::Plain => count * column.element().bytes(),
            Self::Lists(which) => which.bytes(rows, capacities) as usize,
            Self::Wide(words) => count * words * WORD_BYTES as usize,
            Self::Corners => corner_words(rows) * WORD_BYTES as usize,
            Self::Extremes => Word::ALL.len() * WORD_BYTES as usize,
            Self::PressureSolve => Solve::BYTES as usize,
            Self::ViscositySolve => ViscositySolve::BYTES as usize,
            Self::Wrenches => wrench_bytes(pushing(column, rows), rows.bodies),
            Self::Images => image_layout::bytes(rows, capacities) as usize,
            Self::Bodies => count * DeviceBody::BYTES as usize,
            Self::Nowhere => 0,
        }
    }

    /// Reads a column from its words on the device.
    pub(super) fn take(self, column: Column, columns: &mut Columns, words: &[u32], capacities: Capacities) {
        match self {
            Self::Plain => take_plain(columns, column, words),
            Self::Lists(which) => take_lists(columns, which, words, capacities),
            Self::Wide(_) => take_wide(columns, column, words),
            Self::Corners => take_corners(columns, words),
            Self::Extremes => take_extremes(columns, column, words),
            Self::PressureSolve => columns.fluid.pressure_solve.state = Value::take(words),
            Self::ViscositySolve => columns.fluid.viscosity_solve.state = Value::take(words),
            Self::Wrenches => take_wrenches(columns, column, words),
            Self::Images | Self::Bodies | Self::Nowhere => {}
        }
    }
}

/// Words of the lists of the corners that controls are: where each begins, the end of the last, and an entry for every corner.
fn corner_words(rows: RowCounts) -> usize {
    rows.nodes + 1 + TET_CORNERS * rows.fluid
}

/// The words of those lists.
pub(super) fn corners(columns: &Columns) -> Vec<u32> {
    let rows = columns.rows;
    let (mut words, mut entries) = (vec![0], Vec::new());
    for control in 0..rows.nodes {
        if control < columns.controls.node.len() {
            entries.extend(columns.controls.corners.of(control, TET_CORNERS * rows.fluid));
        }
        words.push(entries.len() as u32);
    }
    words.extend(entries);
    words
}

fn take_corners(columns: &mut Columns, words: &[u32]) {
    let rows = columns.rows;
    let Some((starts, entries)) = words.split_at_checked(rows.nodes + 1) else { return };
    let list = |ends: &[u32]| entries[ends[0] as usize..ends[1] as usize].to_vec();
    let mut lists: Vec<Vec<u32>> = starts.windows(2).map(list).collect();
    lists.resize_with(padded(rows.nodes), Vec::new);
    columns.controls.corners = Neighbors::from_lists(&lists, (TET_CORNERS * rows.fluid) as u32);
}

/// Takes over rows of several words, and pads them with rows outside of sponges.
fn take_wide(columns: &mut Columns, column: Column, words: &[u32]) {
    let (rows, outside) = (padded(columns.rows.fluid), [columns.rows.nodes as u32; TET_CORNERS]);
    if column == Column::FluidCorners {
        take_rows(&mut columns.fluid.corners.0, words, outside, rows);
    } else {
        take_rows(&mut columns.fluid.shares.0, words, [[0.0; ROW]; TET_CORNERS], rows);
    }
}

/// The words of rows of several words.
pub(super) fn wide_words(columns: &Columns, column: Column) -> Vec<u32> {
    let mut words = Vec::new();
    columns.data(column).visit_words(columns.rows.fluid, &mut |word| words.push(word));
    words
}

/// Rows of the store that pushes bodies.
fn pushing(column: Column, rows: RowCounts) -> usize {
    if column == Column::BodyNodeWrenches { rows.nodes } else { rows.fluid }
}

/// The words of the first rows of a plain array.
pub(super) fn plain_bytes(columns: &Columns, column: Column, rows: usize) -> &[u8] {
    match columns.data(column).plain() {
        Some(Plain::Rows(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        Some(Plain::Values(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        Some(Plain::Words(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        None => &[],
    }
}

/// Lists, their number, and the number of rows that they are of.
pub(super) fn lists(columns: &mut Columns, which: List) -> (&mut Neighbors, usize, usize) {
    let rows = columns.rows;
    match which {
        List::Neighbors => (&mut columns.fluid.neighbors, rows.fluid, rows.fluid),
        List::Controls => (&mut columns.fluid.controls, rows.fluid, rows.nodes),
        List::ControlFluid => (&mut columns.controls.fluid, rows.nodes, rows.fluid),
        _ => (&mut columns.nodes.pairs, rows.nodes, rows.nodes),
    }
}

/// Where a list has its length (0) and its entries (from 1). There is one line for all k-th entries, but a line a list for controls,
/// whose threads share a list.
pub(super) fn list_layout(
    which: List,
    rows: usize,
    capacities: Capacities,
) -> impl Fn(usize, usize) -> usize {
    let length = which.capacity(capacities) + 1;
    move |k, row| if which == List::ControlFluid { row * length + k } else { k * rows + row }
}

fn take_lists(columns: &mut Columns, which: List, words: &[u32], capacities: Capacities) {
    let (lists, rows, targets) = lists(columns, which);
    let place = list_layout(which, rows, capacities);
    let length = |row: usize| words[place(0, row)] as usize;
    let entries = |row: usize| (1..=length(row)).map(|k| words[place(k, row)]).collect();
    let mut all: Vec<Vec<u32>> = (0..rows).map(entries).collect();
    all.resize_with(padded(rows), Vec::new);
    *lists = Neighbors::from_lists(&all, targets as u32);
}

fn take_wrenches(columns: &mut Columns, column: Column, words: &[u32]) {
    let words: &[f32] = bytemuck::cast_slice(words);
    let mut wrenches: Vec<Wrench> = words.chunks_exact(WRENCH_FLOATS).map(wrench).collect();
    // Chunks of the CPU, which may go on with them, are smaller than groups.
    let chunks = padded(pushing(column, columns.rows)).div_ceil(CHUNK);
    wrenches.resize(chunks * columns.rows.bodies, Wrench::default());
    let all = &mut columns.bodies;
    let to = match column {
        Column::BodyFluidWrenches => &mut all.fluid_wrenches,
        Column::BodyPressureWrenches => &mut all.pressure_wrenches,
        _ => &mut all.node_wrenches,
    };
    *to = Wrenches(wrenches);
}

/// Takes over the words of rows, and pads them.
fn take_rows<T: bytemuck::Pod>(data: &mut Vec<T>, words: &[u32], padding: T, to: usize) {
    data.resize(size_of_val(words) / size_of::<T>(), padding);
    bytemuck::cast_slice_mut(&mut data[..]).copy_from_slice(words);
    data.resize(to, padding);
}

/// Takes over a column that is a plain array.
pub(super) fn take_plain(columns: &mut Columns, column: Column, words: &[u32]) {
    if words.is_empty() && column.need().is_some() {
        // The scene does without.
        return;
    }
    let rows = columns.rows.of(column.store());
    // The one column that the CPU does not pad.
    let to = if column == Column::ControlNode { rows } else { padded(rows) };
    let padding = column.padding();
    match columns.data_mut(column).plain_mut() {
        Some(PlainMut::Rows(data)) => take_rows(data, words, padding.row(), to),
        Some(PlainMut::Values(data)) => take_rows(data, words, 0.0, to),
        Some(PlainMut::Words(data)) => take_rows(data, words, padding.word(), to),
        None => {}
    }
}

fn take_extremes(columns: &mut Columns, column: Column, words: &[u32]) {
    let row = |word: u32| if word == 0 { 0 } else { u32::MAX - word + 1 };
    // All of it in the first chunk, none in the others, which the CPU may go on with.
    let chunks = columns.rows.of(column.store()).div_ceil(CHUNK).max(1);
    let all = |extreme: Extreme| {
        let mut all = vec![Extreme::default(); chunks];
        all[0] = extreme;
        Extremes(all)
    };
    if column == Column::FluidExtremes {
        columns.fluid.extremes = all(Extreme {
            speed_squared: f32::from_bits(words[Word::FluidSpeed as usize]),
            acceleration_squared: f32::from_bits(words[Word::FluidAcceleration as usize]),
            not_finite: row(words[Word::FluidRow as usize]),
        });
    } else {
        columns.nodes.extremes = all(Extreme {
            speed_squared: f32::from_bits(words[Word::NodeSpeed as usize]),
            acceleration_squared: 0.0,
            not_finite: row(words[Word::NodeRow as usize]),
        });
    }
}

/// Whether a scene has rows of a column.
pub(super) fn is_there(params: &Params, rows: RowCounts, column: Column) -> bool {
    let contents = Contents { params, rows, bodies: &[], touch: params.has_touch() };
    column.need().is_none_or(|need| need.missing(&contents).is_none())
}

/// Whether a column is a plain array that devices hold.
pub(super) fn is_plain(column: Column) -> bool {
    Form::of(column) == Form::Plain
}

/// Rows of a column that a device holds.
pub(super) fn rows_of(params: &Params, rows: RowCounts, column: Column) -> usize {
    if is_there(params, rows, column) { rows.of(column.store()) } else { 0 }
}

/// Name and bytes of the buffers of all columns that are plain arrays.
pub(super) fn plain_buffers(params: &Params, rows: RowCounts) -> Vec<(&'static str, u64)> {
    let columns = Column::ALL.iter().copied().filter(|column| is_plain(*column));
    let size = |column: Column| (rows_of(params, rows, column) * column.element().bytes()) as u64;
    let own = columns.map(|column| (column.buffer(), size(column)));
    own.chain(NEXT.map(|(column, name)| (name, size(column)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: RowCounts = RowCounts { fluid: 100, nodes: 30, tets: 90, bodies: 2 };
    const CAPACITIES: Capacities = [8; 8];

    #[test]
    fn every_column_that_a_device_holds_has_bytes() {
        for column in Column::ALL.iter().copied() {
            let form = Form::of(column);
            assert_eq!(form.bytes(column, ROWS, CAPACITIES) > 0, form != Form::Nowhere, "{}", column.name());
            assert_eq!(form == Form::Nowhere, column.is_on_host_only(), "{}", column.name());
        }
        // All words of the shared buffer are read back, for either side.
        assert_eq!(Form::Extremes.bytes(Column::NodeExtremes, ROWS, CAPACITIES), 52);
    }

    #[test]
    fn words_of_columns_that_are_not_plain_go_there_and_back() {
        let mut columns = Columns { rows: ROWS, ..Columns::default() };
        let words: Vec<u32> = (1..=10).collect();
        for column in [Column::FluidExtremes, Column::FluidPressureSolve, Column::BodyFluidWrenches] {
            let form = Form::of(column);
            let words = if form == Form::Wrenches {
                (0..form.bytes(column, ROWS, CAPACITIES) as u32 / 4)
                    .map(|word| (word as f32).to_bits())
                    .collect()
            } else {
                words.clone()
            };
            form.take(column, &mut columns, &words, CAPACITIES);
            let of = |columns: &Columns| {
                let mut words = Vec::new();
                columns.data(column).visit_words(usize::MAX, &mut |word| words.push(word));
                words
            };
            let found = of(&columns);
            columns.data_mut(column).poison();
            assert_ne!(of(&columns), found, "{}: the control", column.name());
            assert!(columns.data_mut(column).take_words(usize::MAX, &found));
            assert_eq!(of(&columns), found, "{}", column.name());
            assert!(!columns.data_mut(column).take_words(usize::MAX, &found[1..]), "one word less");
        }
    }
}
