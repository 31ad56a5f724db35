//! Columns to the device and back.

use std::collections::BTreeSet;

use super::{
    answer::Extreme as Word,
    error::GpuError,
    groups::wrench_bytes,
    layout::Value,
    pack::DeviceBody,
    resident::{Resident, capacities},
    stars,
};
use crate::{
    body::Wrench,
    column::{Plain, PlainMut, padded},
    columns::{Column, Columns, RowCounts},
    contents::Contents,
    couple::weights::sources,
    cpu::CHUNK,
    grid::neighbors::Neighbors,
    params::Params,
    reduce::{Extreme, Extremes, Wrenches},
    sph::{pressure_solve::Solve, viscosity_solve::State as ViscositySolve},
};

/// Particles as `sph::advect` leaves them, which the next step sorts.
const NEXT: [(Column, &str); 3] = [
    (Column::FluidPosition, "fluid_position_next"),
    (Column::FluidVelocity, "fluid_velocity_next"),
    (Column::FluidId, "fluid_id_next"),
];

/// The buffer of a column; `sorted` says that the particles are in the order of this step.
fn buffer_name(column: Column, sorted: bool) -> &'static str {
    let next = NEXT.iter().find(|(next, _)| *next == column && !sorted);
    next.map_or_else(|| column.buffer(), |(_, name)| name)
}

/// Whether a column is a plain array that devices hold.
fn is_plain(column: Column) -> bool {
    column.element().bytes() > 0 && !column.is_on_host_only()
}

/// The words of the first rows of a plain array.
fn bytes(columns: &Columns, column: Column, rows: usize) -> &[u8] {
    match columns.data(column).plain() {
        Some(Plain::Rows(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        Some(Plain::Values(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        Some(Plain::Words(data)) => bytemuck::cast_slice(&data[..rows.min(data.len())]),
        None => &[],
    }
}

/// Takes over the words of rows, and pads them.
fn take_rows<T: bytemuck::Pod>(data: &mut Vec<T>, words: &[u32], padding: T, to: usize) {
    data.resize(size_of_val(words) / size_of::<T>(), padding);
    bytemuck::cast_slice_mut(&mut data[..]).copy_from_slice(words);
    data.resize(to, padding);
}

/// The lists of a column: which of the four they are.
fn list_of(column: Column) -> Option<(&'static str, usize)> {
    match column {
        Column::FluidNeighbors => Some(("fluid_neighbors", 0)),
        Column::FluidControls => Some(("fluid_controls", 1)),
        Column::ControlFluid => Some(("control_fluid", 2)),
        Column::NodePairs => Some(("node_pairs", 3)),
        _ => None,
    }
}

fn lists(columns: &mut Columns, which: usize) -> (&mut Neighbors, usize, usize) {
    let rows = columns.rows;
    match which {
        0 => (&mut columns.fluid.neighbors, rows.fluid, rows.fluid),
        1 => (&mut columns.fluid.controls, rows.fluid, rows.nodes),
        2 => (&mut columns.controls.fluid, rows.nodes, rows.fluid),
        _ => (&mut columns.nodes.pairs, rows.nodes, rows.nodes),
    }
}

/// Columns that the passes of vertex block descent find beside the stars, for want of bindings.
fn is_beside_stars(column: Column) -> bool {
    let touch = [Column::NodeTouch, Column::NodeTouchStiffness, Column::NodeTouchBetween];
    column == Column::NodeWetting || touch.contains(&column)
}

/// Whether a scene has rows of a column.
fn is_there(params: &Params, rows: RowCounts, column: Column) -> bool {
    let contents = Contents { params, rows, bodies: &[], touch: params.has_touch() };
    column.need().is_none_or(|need| need.missing(&contents).is_none())
}

impl Resident {
    /// Sends columns to the device; those that it does not hold ([`Column::is_on_host_only`]) are left out. `sorted` says that the
    /// particles are in the order of this step already, for kernels that come after `grid::sort_fluid`.
    ///
    /// # Errors
    /// Lists that are longer than those of the device do not fit its memory, or the device was lost.
    pub fn upload(&mut self, columns: &mut Columns, which: &[Column], sorted: bool) -> Result<(), GpuError> {
        self.sorted = sorted;
        // Weights are computed where they are needed, from the points on both sides.
        let points: BTreeSet<_> =
            which.iter().filter_map(|column| sources(*column)).flat_map(|(_, points)| points).collect();
        for column in which.iter().chain(points) {
            if is_plain(*column) {
                let rows = self.rows_of(*column);
                self.write(buffer_name(*column, sorted), bytes(columns, *column, rows));
                if is_beside_stars(*column) && rows > 0 {
                    let stars = stars::stars(&columns.nodes, self.rows.nodes, self.params.has_touch());
                    self.write("node_stars", bytemuck::cast_slice(&stars));
                    self.fill_ranges(columns);
                }
            } else if let Some((name, list)) = list_of(*column) {
                self.upload_lists(columns, name, list)?;
            } else {
                self.upload_other(columns, *column);
            }
        }
        self.gpu.check_lost()
    }

    fn upload_lists(
        &mut self,
        columns: &mut Columns,
        name: &'static str,
        which: usize,
    ) -> Result<(), GpuError> {
        let (lists, rows, targets) = lists(columns, which);
        let lists: Vec<Vec<u32>> = (0..rows).map(|query| lists.of(query, targets).collect()).collect();
        let longest = lists.iter().map(Vec::len).max().unwrap_or(0) as u32;
        if longest > self.capacities[which] {
            let mut needed = [0; 4];
            needed[which] = longest;
            self.lengthen(needed)?;
        }
        let place = self.list_layout(which, rows);
        let mut words = vec![0_u32; rows * (self.capacities[which] as usize + 1)];
        for (row, list) in lists.iter().enumerate() {
            words[place(0, row)] = list.len() as u32;
            list.iter().enumerate().for_each(|(k, target)| words[place(k + 1, row)] = *target);
        }
        self.write(name, bytemuck::cast_slice(&words));
        Ok(())
    }

    /// Where a list has its length (0) and its entries (from 1): one line for all k-th entries, but a line a list for
    /// controls, whose threads share a list.
    fn list_layout(&self, which: usize, rows: usize) -> impl Fn(usize, usize) -> usize + use<> {
        let length = self.capacities[which] as usize + 1;
        move |k, row| if which == 2 { row * length + k } else { k * rows + row }
    }

    fn upload_other(&mut self, columns: &Columns, column: Column) {
        let bodies = columns.rows.bodies;
        match column {
            Column::BodyStates => self.upload_bodies(&columns.bodies.states.0),
            Column::BodyNodeWrenches => {
                self.upload_wrenches("body_node_wrenches", &columns.bodies.node_wrenches, bodies)
            }
            Column::BodyFluidWrenches => {
                self.upload_wrenches("body_fluid_wrenches", &columns.bodies.fluid_wrenches, bodies);
            }
            Column::FluidExtremes | Column::NodeExtremes => self.upload_extremes(columns, column),
            Column::FluidPressureSolve => {
                self.write(
                    "fluid_pressure_solve",
                    bytemuck::cast_slice(&columns.fluid.pressure_solve.state.words()),
                );
            }
            Column::FluidViscositySolve => {
                self.write(
                    "fluid_viscosity_solve",
                    bytemuck::cast_slice(&columns.fluid.viscosity_solve.state.words()),
                );
            }
            _ => {}
        }
    }

    /// The words of one side only: those of the other may be newer on the device.
    fn upload_extremes(&self, columns: &Columns, column: Column) {
        let is_fluid = column == Column::FluidExtremes;
        let found = if is_fluid { columns.fluid.extremes.total() } else { columns.nodes.extremes.total() };
        let row = found.not_finite.checked_sub(1).map_or(0, |row| u32::MAX - row);
        let (speed, acceleration) = (found.speed_squared.to_bits(), found.acceleration_squared.to_bits());
        if is_fluid {
            self.write_extreme(Word::FluidSpeed, speed);
            self.write_extreme(Word::FluidAcceleration, acceleration);
            self.write_extreme(Word::FluidRow, row);
        } else {
            self.write_extreme(Word::NodeSpeed, speed);
            self.write_extreme(Word::NodeRow, row);
        }
    }

    /// All of a wrench in the first group, none in the others.
    fn upload_wrenches(&self, name: &'static str, wrenches: &Wrenches, bodies: usize) {
        let mut words = vec![0.0_f32; self.buffer(name).size() as usize / 4];
        for body in 0..bodies {
            let total = wrenches.total(body, bodies);
            let rows = [total.impulse, total.angular_impulse].map(glam::DVec3::as_vec3);
            for (half, vector) in rows.into_iter().enumerate() {
                let first = (body * 2 + half) * 4;
                if let Some(slot) = words.get_mut(first..first + 3) {
                    slot.copy_from_slice(&vector.to_array());
                }
            }
        }
        self.write(name, bytemuck::cast_slice(&words));
    }

    /// Reads columns back; those that the device does not hold are left as they are.
    ///
    /// # Errors
    /// The device was lost, or there is no memory to copy to.
    pub fn download(&self, columns: &mut Columns, which: &[Column]) -> Result<(), GpuError> {
        let mut wanted = Vec::new();
        for column in which {
            if let Some(buffer) = self.plain_buffer(*column) {
                wanted.push(buffer);
            } else if let Some((name, list)) = list_of(*column) {
                let rows = lists(columns, list).1;
                wanted.push((*column, name, rows * (self.capacities[list] as usize + 1) * 4));
            } else if matches!(column, Column::FluidExtremes | Column::NodeExtremes) {
                wanted.push((*column, "extremes", 4 * Word::ALL.len()));
            } else if *column == Column::FluidPressureSolve {
                wanted.push((*column, "fluid_pressure_solve", Solve::BYTES as usize));
            } else if *column == Column::FluidViscositySolve {
                wanted.push((*column, "fluid_viscosity_solve", ViscositySolve::BYTES as usize));
            } else if let Some((name, size)) = self.wrench_buffer(*column) {
                wanted.push((*column, name, size));
            }
        }
        let names: Vec<_> = wanted.iter().map(|(_, name, size)| (*name, *size as u64)).collect();
        let data = self.read(&names)?;
        for ((column, _, _), words) in wanted.iter().zip(&data) {
            self.take(columns, *column, words);
        }
        Ok(())
    }

    /// Rows of a column that the device holds.
    fn rows_of(&self, column: Column) -> usize {
        if is_there(&self.params, self.rows, column) { self.rows.of(column.store()) } else { 0 }
    }

    /// Name and bytes of the buffers of all columns that are plain arrays.
    pub(super) fn plain_buffers(&self) -> Vec<(&'static str, u64)> {
        let columns = Column::ALL.iter().copied().filter(|column| is_plain(*column));
        let size = |column: Column| (self.rows_of(column) * column.element().bytes()) as u64;
        let own = columns.map(|column| (column.buffer(), size(column)));
        own.chain(NEXT.map(|(column, name)| (name, size(column)))).collect()
    }

    fn wrench_buffer(&self, column: Column) -> Option<(&'static str, usize)> {
        let bytes = |rows| wrench_bytes(rows, self.rows.bodies);
        match column {
            Column::BodyFluidWrenches => Some(("body_fluid_wrenches", bytes(self.rows.fluid))),
            Column::BodyNodeWrenches => Some(("body_node_wrenches", bytes(self.rows.nodes))),
            _ => None,
        }
    }

    /// A column that is a plain array, with its buffer and its bytes.
    pub(super) fn plain_buffer(&self, column: Column) -> Option<(Column, &'static str, usize)> {
        let size = self.rows_of(column) * column.element().bytes();
        is_plain(column).then(|| (column, buffer_name(column, self.sorted), size))
    }

    fn take(&self, columns: &mut Columns, column: Column, words: &[u32]) {
        if take_plain(columns, column, words) {
            return;
        }
        if let Some((_, which)) = list_of(column) {
            let (lists, rows, targets) = lists(columns, which);
            let place = self.list_layout(which, rows);
            let length = |row: usize| words[place(0, row)] as usize;
            let entries = |row: usize| (1..=length(row)).map(|k| words[place(k, row)]).collect();
            let mut all: Vec<Vec<u32>> = (0..rows).map(entries).collect();
            all.resize_with(padded(rows), Vec::new);
            *lists = Neighbors::from_lists(&all, targets as u32);
        } else if matches!(column, Column::FluidExtremes | Column::NodeExtremes) {
            take_extremes(columns, column, words);
        } else if column == Column::FluidPressureSolve {
            columns.fluid.pressure_solve.state = Value::take(words);
        } else if column == Column::FluidViscositySolve {
            columns.fluid.viscosity_solve.state = Value::take(words);
        } else {
            let words: &[f32] = bytemuck::cast_slice(words);
            let wrenches = words
                .chunks_exact(8)
                .map(|words| Wrench { impulse: vector(&words[..3]), angular_impulse: vector(&words[4..7]) });
            let mut wrenches: Vec<Wrench> = wrenches.collect();
            let is_fluid = column == Column::BodyFluidWrenches;
            let rows = if is_fluid { columns.rows.fluid } else { columns.rows.nodes };
            // Chunks of the CPU, which may go on with them, are smaller than groups.
            wrenches.resize(padded(rows).div_ceil(CHUNK) * columns.rows.bodies, Wrench::default());
            let all = &mut columns.bodies;
            *if is_fluid { &mut all.fluid_wrenches } else { &mut all.node_wrenches } = Wrenches(wrenches);
        }
    }
}

/// Makes room for a column that is a plain array, so that a kernel of the CPU finds it where those before it ran
/// elsewhere.
pub fn make_room(columns: &mut Columns, column: Column) {
    if is_beside_stars(column) {
        // There from the beginning, or not at all.
        return;
    }
    if !is_plain(column) {
        return;
    }
    let (rows, padding) = (padded(columns.rows.of(column.store())), column.padding());
    match columns.data_mut(column).plain_mut() {
        Some(PlainMut::Rows(data)) if data.len() < rows => data.resize(rows, padding.row()),
        Some(PlainMut::Values(data)) if data.len() < rows => data.resize(rows, 0.0),
        Some(PlainMut::Words(data)) if data.len() < rows && column != Column::ControlNode => {
            data.resize(rows, padding.word());
        }
        _ => {}
    }
}

/// Takes over a column that is a plain array, if it is one.
pub(super) fn take_plain(columns: &mut Columns, column: Column, words: &[u32]) -> bool {
    if !is_plain(column) {
        return false;
    }
    if words.is_empty() && column.need().is_some() {
        // The scene does without.
        return true;
    }
    let rows = columns.rows.of(column.store());
    // The one column that the CPU does not pad.
    let to = if column == Column::ControlNode { rows } else { padded(rows) };
    let padding = column.padding();
    match columns.data_mut(column).plain_mut() {
        Some(PlainMut::Rows(data)) => take_rows(data, words, padding.row(), to),
        Some(PlainMut::Values(data)) => take_rows(data, words, 0.0, to),
        Some(PlainMut::Words(data)) => take_rows(data, words, padding.word(), to),
        None => return false,
    }
    true
}

pub(super) fn vector(words: &[f32]) -> glam::DVec3 {
    glam::DVec3::new(f64::from(words[0]), f64::from(words[1]), f64::from(words[2]))
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

/// Bytes of a column on a device, in a scene of these parameters: lists as long as those of a fluid and a lattice at
/// rest, 0 for columns that a device does not hold.
#[must_use]
pub fn column_bytes(params: &Params, rows: RowCounts, column: Column) -> u64 {
    let count = rows.of(column.store()) as u64;
    if !is_there(params, rows, column) {
        return 0;
    }
    if is_plain(column) {
        return count * column.element().bytes() as u64;
    }
    if let Some((_, which)) = list_of(column) {
        return count * (u64::from(capacities(params, rows)[which]) + 1) * 4;
    }
    match column {
        Column::FluidExtremes | Column::NodeExtremes => 20,
        Column::FluidPressureSolve => Solve::BYTES,
        Column::FluidViscositySolve => ViscositySolve::BYTES,
        Column::BodyStates => count * DeviceBody::BYTES,
        Column::BodyFluidWrenches => wrench_bytes(rows.fluid, rows.bodies) as u64,
        Column::BodyNodeWrenches => wrench_bytes(rows.nodes, rows.bodies) as u64,
        _ => 0,
    }
}
