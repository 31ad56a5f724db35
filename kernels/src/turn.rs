//! What a turn of the container in a step does to velocities in it: Euler's, Coriolis's and the centrifugal acceleration.
//!
//! ```text
//! v <- C v + F x
//! ```
//!
//! It is done before the step, and is therefore no phase of it: a step that is begun anew must not do it twice.

use glam::{Mat3, Vec3, Vec4};

use crate::{
    columns::{Columns, lane},
    layout::layout,
};

layout! {
    /// The matrices, column by column; the fourth numbers are zero.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Turn {
        coriolis_x: [f32; 4],
        coriolis_y: [f32; 4],
        coriolis_z: [f32; 4],
        field_x: [f32; 4],
        field_y: [f32; 4],
        field_z: [f32; 4],
    }
}

impl Turn {
    /// Of the matrices C \[1\] and F \[1/s\].
    #[must_use]
    pub fn new(coriolis: Mat3, field: Mat3) -> Self {
        let column = |vector: Vec3| vector.extend(0.0).to_array();
        Self {
            coriolis_x: column(coriolis.x_axis),
            coriolis_y: column(coriolis.y_axis),
            coriolis_z: column(coriolis.z_axis),
            field_x: column(field.x_axis),
            field_y: column(field.y_axis),
            field_z: column(field.z_axis),
        }
    }

    /// C and F.
    #[must_use]
    pub fn matrices(&self) -> [Mat3; 2] {
        let matrix = |columns: [[f32; 4]; 3]| {
            let [x, y, z] = columns.map(|column| Vec4::from_array(column).truncate());
            Mat3::from_cols(x, y, z)
        };
        [
            matrix([self.coriolis_x, self.coriolis_y, self.coriolis_z]),
            matrix([self.field_x, self.field_y, self.field_z]),
        ]
    }

    /// Changes the velocities of all particles, and of the nodes that no body holds.
    pub fn apply(&self, columns: &mut Columns) {
        let [coriolis, field] = self.matrices();
        let turn = |[x, y, z, _]: &[f32; 4], velocity: &mut [f32; 4]| {
            let own = Vec3::new(velocity[0], velocity[1], velocity[2]);
            let new = coriolis * own + field * Vec3::new(*x, *y, *z);
            *velocity = [new.x, new.y, new.z, velocity[3]];
        };
        let Columns { rows, fluid, nodes, .. } = columns;
        let particles = fluid.position.iter().zip(&mut fluid.velocity).take(rows.fluid);
        particles.for_each(|(position, velocity)| turn(position, velocity));
        for (position, velocity) in nodes.position.iter().zip(&mut nodes.velocity).take(rows.nodes) {
            if position[lane::nodes::position::INVERSE_MASS] > 0.0 {
                turn(position, velocity);
            }
        }
    }
}
