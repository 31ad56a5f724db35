//! The state: columns that a saved file holds, and that a roll back takes over.

use glam::{Quat, Vec3};

use crate::{
    body::{Bodies, BodyState},
    column::{ColumnData, Plain, PlainMut, bits, padded, take_rows},
    columns::{Column, Columns, Fluid, Store},
    reduce::Wrenches,
};

impl Columns {
    /// Takes over all columns of a state ([`Life::is_saved`](crate::column::Life::is_saved)) from columns of the same scene.
    /// Allocates nothing where these columns have the room.
    pub fn copy_state(&mut self, from: &Self) {
        self.rows = from.rows;
        for column in Column::ALL.iter().filter(|column| column.life().is_saved()) {
            match (self.data_mut(*column).plain_mut(), from.data(*column).plain()) {
                (Some(PlainMut::Rows(own)), Some(Plain::Rows(other))) => own.clone_from(other),
                (Some(PlainMut::Values(own)), Some(Plain::Values(other))) => own.clone_from(other),
                (Some(PlainMut::Words(own)), Some(Plain::Words(other))) => own.clone_from(other),
                // Shapes of bodies never change.
                _ => self.bodies.states.copy_states(&from.bodies.states),
            }
        }
    }
}

impl Columns {
    /// Changes the number of particles. The first rows keep their state, and new ones are padding until they are filled. What a step
    /// rebuilds is emptied: its rows would be those of other particles. Allocates nothing where the columns have the room.
    pub fn set_fluid_rows(&mut self, rows: usize) {
        self.rows.fluid = rows;
        self.bodies.fluid_wrenches = Wrenches::default();
        if rows == 0 {
            // As in a scene that never had any.
            self.fluid = Fluid::default();
            self.nodes.saturation.clear();
            return;
        }
        for column in fluid_columns() {
            let to = if column.life().is_rebuilt() { 0 } else { padded(rows) };
            let padding = column.padding();
            match self.data_mut(column).plain_mut() {
                Some(PlainMut::Rows(data)) => fit(data, (rows, to), padding.row()),
                Some(PlainMut::Values(data)) => fit(data, (rows, to), 0.0),
                Some(PlainMut::Words(data)) => fit(data, (rows, to), padding.word()),
                None => {}
            }
        }
    }

    /// Keeps the particles that stay, in their order.
    pub fn keep_fluid_rows(&mut self, stays: &[bool]) {
        for column in fluid_columns().filter(|column| !column.life().is_rebuilt()) {
            match self.data_mut(column).plain_mut() {
                Some(PlainMut::Rows(data)) => keep(data, stays),
                Some(PlainMut::Values(data)) => keep(data, stays),
                Some(PlainMut::Words(data)) => keep(data, stays),
                None => {}
            }
        }
        self.set_fluid_rows(stays.iter().filter(|stays| **stays).count());
    }

    /// Makes room for as many particles in all columns that have any rows, and in those of the state.
    pub fn reserve_fluid(&mut self, rows: usize) {
        let rows = padded(rows);
        for column in fluid_columns() {
            let is_used = |length: usize| length > 0 || !column.life().is_rebuilt();
            match self.data_mut(column).plain_mut() {
                Some(PlainMut::Rows(data)) if is_used(data.len()) => reserve(data, rows),
                Some(PlainMut::Values(data)) if is_used(data.len()) => reserve(data, rows),
                Some(PlainMut::Words(data)) if is_used(data.len()) => reserve(data, rows),
                _ => {}
            }
        }
    }
}

fn fluid_columns() -> impl Iterator<Item = Column> {
    Column::ALL.iter().copied().filter(|column| column.store() == Store::Fluid)
}

/// Keeps the first rows; grows by halves, so that rows that come one by one seldom move.
fn fit<T: Clone>(data: &mut Vec<T>, (rows, to): (usize, usize), padding: T) {
    data.truncate(rows.min(to));
    if to > data.capacity() {
        data.reserve_exact(to.max(data.capacity() + data.capacity() / 2) - data.len());
    }
    data.resize(to, padding);
}

/// Drops the rows that go, and what is behind them.
fn keep<T>(data: &mut Vec<T>, stays: &[bool]) {
    let mut row = 0;
    data.retain(|_| {
        row += 1;
        stays.get(row - 1).copied().unwrap_or(false)
    });
}

fn reserve<T>(data: &mut Vec<T>, rows: usize) {
    data.reserve_exact(rows.saturating_sub(data.len()));
}

impl Bodies {
    /// Takes over poses, velocities and what follows from them of the same bodies, or all of them if these are others.
    pub fn copy_states(&mut self, from: &Self) {
        if self.0.len() != from.0.len() {
            self.0.clone_from(&from.0);
        }
        for (own, other) in self.0.iter_mut().zip(&from.0) {
            own.state = other.state;
            (own.inverse_mass, own.inverse_inertia) = (other.inverse_mass, other.inverse_inertia);
        }
    }
}

impl ColumnData for Bodies {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for body in &self.0 {
            let BodyState { position, rotation, linear_velocity, angular_velocity } = body.state;
            position.to_array().into_iter().for_each(|value| visit(bits(value)));
            rotation.to_array().into_iter().for_each(|value| visit(bits(value)));
            linear_velocity.to_array().into_iter().for_each(|value| visit(bits(value)));
            angular_velocity.to_array().into_iter().for_each(|value| visit(bits(value)));
        }
    }
    fn take_words(&mut self, _rows: usize, words: &[u32]) -> bool {
        let vector =
            |words: &[u32]| Vec3::from_array(std::array::from_fn(|axis| f32::from_bits(words[axis])));
        let count = self.0.len();
        take_rows(&mut self.0, count, words, 13, |body, words| {
            let rotation = std::array::from_fn(|index| f32::from_bits(words[3 + index]));
            body.state = BodyState {
                position: vector(words),
                rotation: Quat::from_array(rotation),
                linear_velocity: vector(&words[7..]),
                angular_velocity: vector(&words[10..]),
            };
        })
    }
    fn poison(&mut self) {
        for body in &mut self.0 {
            (body.state.position, body.state.linear_velocity) = (Vec3::NAN, Vec3::NAN);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::FAR_ROW;

    #[test]
    fn rows_come_and_go_without_a_trace_and_without_memory() {
        let mut columns = Columns::default();
        columns.set_fluid_rows(10);
        columns.fluid.position[..10].fill([1.0; 4]);
        columns.fluid.density = vec![1000.0; 16];
        columns.reserve_fluid(100);
        let room = columns.fluid.position.as_ptr();
        for rows in [9, 100, 3] {
            let kept = rows.min(columns.rows.fluid).min(10);
            columns.set_fluid_rows(rows);
            assert_eq!(columns.fluid.position.as_ptr(), room, "nothing moved");
            let Fluid { position, velocity, id, density, .. } = &columns.fluid;
            assert_eq!([position.len(), velocity.len(), id.len()], [padded(rows); 3]);
            assert!(position[..kept].iter().all(|row| *row == [1.0; 4]), "{rows}");
            assert!(position[rows..].iter().all(|row| *row == FAR_ROW) && density.is_empty(), "{rows}");
            columns.fluid.position[kept..rows].fill([1.0; 4]);
        }
        columns.fluid.id[..3].copy_from_slice(&[5, 6, 7]);
        columns.keep_fluid_rows(&[true, false, true]);
        assert_eq!((columns.rows.fluid, &columns.fluid.id[..3]), (2, &[5, 7, u32::MAX][..]));
        // Negative control: beyond the reserve memory moves.
        columns.set_fluid_rows(100_000);
        assert_ne!(columns.fluid.position.as_ptr(), room);
        columns.set_fluid_rows(0);
        assert!(columns.fluid.position.is_empty());
    }

    #[test]
    fn bodies_are_the_only_column_of_a_state_that_is_not_plain() {
        let columns = Columns::default();
        let saved = Column::ALL.iter().filter(|column| column.life().is_saved());
        let other: Vec<_> = saved.filter(|column| columns.data(**column).plain().is_none()).collect();
        assert_eq!(other, [&Column::BodyStates]);
    }
}
