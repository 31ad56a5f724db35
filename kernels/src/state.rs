//! The state: columns that a saved file holds, and that a roll back takes over.

use glam::{Quat, Vec3};

use crate::{
    body::{Bodies, BodyState},
    column::{ColumnData, Plain, PlainMut, take_rows},
    columns::{Column, Columns},
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
            position.to_array().into_iter().for_each(|value| visit(value.to_bits()));
            rotation.to_array().into_iter().for_each(|value| visit(value.to_bits()));
            linear_velocity.to_array().into_iter().for_each(|value| visit(value.to_bits()));
            angular_velocity.to_array().into_iter().for_each(|value| visit(value.to_bits()));
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

    #[test]
    fn bodies_are_the_only_column_of_a_state_that_is_not_plain() {
        let columns = Columns::default();
        let saved = Column::ALL.iter().filter(|column| column.life().is_saved());
        let other: Vec<_> = saved.filter(|column| columns.data(**column).plain().is_none()).collect();
        assert_eq!(other, [&Column::BodyStates]);
    }
}
