//! `bodies.csv`: a row for every body and frame.

use std::{
    fmt::Write as _,
    fs::File,
    io::Write as _,
    path::{Path, PathBuf},
};

use sorb::World;

use super::table::begin;
use crate::error::CliError;

const HEADING: &str = "frame,time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_m_per_s,vy_m_per_s,vz_m_per_s,\
                       fluid_force_x_N,fluid_force_y_N,fluid_force_z_N\n";

/// The table while it is written. The rows of a frame reach the file at once, so that an end by force leaves whole frames.
#[derive(Debug)]
pub(super) struct Bodies {
    path: PathBuf,
    file: File,
}

impl Bodies {
    /// Creates the file with its heading, and with the rows of frames that are done, as
    /// [`Table::create`](super::table::Table::create).
    ///
    /// # Errors
    /// The file cannot be read or written.
    pub(super) fn create(path: &Path, done: u32) -> Result<Self, CliError> {
        let begin = begin(path, HEADING, done)?;
        let file = File::create(path).map_err(CliError::write(path))?;
        let mut bodies = Self { path: path.to_owned(), file };
        bodies.write(&begin)?;
        Ok(bodies)
    }

    /// Writes the rows of a frame.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn rows(&mut self, frame: usize, world: &World) -> Result<(), CliError> {
        let forces = world.body_fluid_forces();
        let (time, scene) = (world.clock().time, world.scene());
        let mut rows = String::new();
        let bodies = world.bodies().iter().zip(&scene.bodies).enumerate();
        for (index, (body, own)) in bodies.filter(|(_, (_, own))| !own.is_removed()) {
            let (state, name) = (&body.state, quoted(&own.name));
            let _ = write!(rows, "{frame},{time:?},{name}");
            let (place, turn, speed) = (state.position, state.rotation, state.linear_velocity);
            // Shortest digits that give the same number back.
            for value in [place.to_array().as_slice(), &turn.to_array(), &speed.to_array()].concat() {
                let _ = write!(rows, ",{value:?}");
            }
            match forces.get(index) {
                Some(force) => {
                    let _ = writeln!(rows, ",{:?},{:?},{:?}", force.x, force.y, force.z);
                }
                None => rows.push_str(",,,\n"),
            }
        }
        self.write(&rows)
    }

    fn write(&mut self, text: &str) -> Result<(), CliError> {
        self.file.write_all(text.as_bytes()).map_err(CliError::write(&self.path))
    }
}

/// A name as a field of a table: in quotes if it would end the field.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_and_quotes_are_one_field() {
        assert_eq!(quoted("ball"), "ball");
        assert_eq!(quoted("a, b"), "\"a, b\"");
        assert_eq!(quoted("the \"ball\""), "\"the \"\"ball\"\"\"");
    }
}
