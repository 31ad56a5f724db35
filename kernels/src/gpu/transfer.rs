//! Columns to the device and back.

use std::collections::BTreeSet;

use super::{
    answer::Extreme as Word,
    capacities::{Capacities, List, capacities},
    error::GpuError,
    form::{Form, corners, is_plain, is_there, list_layout, lists, plain_bytes, rows_of, wide_words},
    groups::WRENCH_FLOATS,
    layout::{ROW, Value, WORD_BYTES},
    resident::Resident,
    stars,
};
use crate::{
    column::{PlainMut, padded},
    columns::{Column, Columns, RowCounts},
    couple::weights::sources,
    params::Params,
    reduce::Wrenches,
};

/// Columns that the passes of vertex block descent find beside the stars, for want of bindings.
fn is_beside_stars(column: Column) -> bool {
    let touch = [Column::NodeTouch, Column::NodeTouchStiffness, Column::NodeTouchBetween];
    column == Column::NodeWetting || touch.contains(&column)
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
            let form = Form::of(*column);
            let name = form.buffer(*column, sorted);
            match form {
                Form::Plain => self.upload_plain(columns, *column, name),
                Form::Lists(which) => self.upload_lists(columns, name, which)?,
                Form::Wide(_) => self.write_words(name, &wide_words(columns, *column)),
                Form::Corners => self.write_words(name, &corners(columns)),
                Form::Extremes => self.upload_extremes(columns, *column),
                Form::PressureSolve => self.write_words(name, &columns.fluid.pressure_solve.state.words()),
                Form::ViscositySolve => self.write_words(name, &columns.fluid.viscosity_solve.state.words()),
                Form::Wrenches => self.upload_wrenches(columns, *column, name),
                Form::Images => self.upload_images(&columns.fluid)?,
                Form::Bodies => self.upload_bodies(&columns.bodies.states.0),
                Form::Nowhere => {}
            }
        }
        self.gpu.check_lost()
    }

    fn upload_plain(&mut self, columns: &Columns, column: Column, name: &'static str) {
        let rows = rows_of(&self.params, self.rows, column);
        self.write(name, plain_bytes(columns, column, rows));
        if is_beside_stars(column) && rows > 0 {
            let stars = stars::stars(&columns.nodes, self.rows.nodes, self.params.has_touch());
            self.write("node_stars", bytemuck::cast_slice(&stars));
            self.fill_ranges(columns);
        }
    }

    fn write_words(&self, name: &'static str, words: &[u32]) {
        self.write(name, bytemuck::cast_slice(words));
    }

    fn upload_lists(
        &mut self,
        columns: &mut Columns,
        name: &'static str,
        which: List,
    ) -> Result<(), GpuError> {
        let (lists, rows, targets) = lists(columns, which);
        let lists: Vec<Vec<u32>> = (0..rows).map(|query| lists.of(query, targets).collect()).collect();
        let longest = lists.iter().map(Vec::len).max().unwrap_or(0) as u32;
        if longest as usize > which.capacity(self.capacities) {
            let mut needed = Capacities::default();
            needed[which as usize] = longest;
            self.lengthen(needed)?;
        }
        let place = list_layout(which, rows, self.capacities);
        let mut words = vec![0_u32; which.words(self.rows, self.capacities)];
        for (row, list) in lists.iter().enumerate() {
            words[place(0, row)] = list.len() as u32;
            list.iter().enumerate().for_each(|(k, target)| words[place(k + 1, row)] = *target);
        }
        self.write(name, bytemuck::cast_slice(&words));
        Ok(())
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
    fn upload_wrenches(&self, columns: &Columns, column: Column, name: &'static str) {
        let (store, bodies) = (&columns.bodies, columns.rows.bodies);
        let wrenches: &Wrenches = match column {
            Column::BodyFluidWrenches => &store.fluid_wrenches,
            Column::BodyPressureWrenches => &store.pressure_wrenches,
            _ => &store.node_wrenches,
        };
        let mut words = vec![0.0_f32; (self.buffer(name).size() / WORD_BYTES) as usize];
        for body in 0..bodies {
            let total = wrenches.total(body, bodies);
            let rows = [total.impulse, total.angular_impulse].map(glam::DVec3::as_vec3);
            for (half, vector) in rows.into_iter().enumerate() {
                let first = body * WRENCH_FLOATS + half * ROW;
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
        let returns = which.iter().filter(|column| Form::of(**column).returns());
        let wanted: Vec<_> = returns
            .map(|column| {
                let form = Form::of(*column);
                let is_there = is_there(&self.params, self.rows, *column) || form != Form::Plain;
                let bytes = if is_there { form.bytes(*column, self.rows, self.capacities) } else { 0 };
                (*column, form.buffer(*column, self.sorted), bytes)
            })
            .collect();
        let names: Vec<_> = wanted.iter().map(|(_, name, size)| (*name, *size as u64)).collect();
        let data = self.read(&names)?;
        for ((column, _, _), words) in wanted.iter().zip(&data) {
            Form::of(*column).take(*column, columns, words, self.capacities);
        }
        if which.contains(&Column::FluidImages) {
            self.download_images(columns)?;
        }
        Ok(())
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

/// Bytes of a column on a device, in a scene of these parameters. Lists count as long as those of a fluid and a lattice at
/// rest, 0 for columns that a device does not hold.
#[must_use]
pub fn column_bytes(params: &Params, rows: RowCounts, column: Column) -> u64 {
    if !is_there(params, rows, column) {
        return 0;
    }
    Form::of(column).bytes(column, rows, capacities(params, rows)) as u64
}
