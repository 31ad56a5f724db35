//! A state from sections of bytes.

use glam::Vec3;
use sorb_kernels::columns::{Column, RowCounts};

use super::{
    body::{CONTAINER, ENGINE, ENGINE_OF_HOST, LOADS, REST, SCENE, SLEEP, WATER, saved_columns},
    columns::{copy_words, fits, take_column},
    error::StateError,
    rest::Rest,
};
use crate::{
    scene::Scene,
    water::Water,
    world::{Origin, World, digest_of, forces::SavedLoads, frame::Frame},
};

/// Sections by name.
#[derive(Debug)]
pub(super) struct Parts<'a>(pub(super) Vec<(&'a str, &'a [u8])>);

impl<'a> Parts<'a> {
    /// The bytes of a section; none if it is absent.
    pub(super) fn of(&self, name: &str) -> &'a [u8] {
        self.0.iter().find(|(own, _)| *own == name).map_or(&[], |(_, bytes)| bytes)
    }
}

pub(crate) fn invalid(what: &str, reason: impl Into<String>) -> StateError {
    StateError::Invalid { what: what.to_owned(), reason: reason.into() }
}

impl World {
    /// Takes over a state of the same scene.
    ///
    /// # Errors
    /// The state is not of this scene, or impossible; the world is unchanged.
    pub(super) fn take_state(&mut self, parts: &Parts<'_>) -> Result<(), StateError> {
        let rows = self.rows_in(parts);
        self.check_sections(parts, rows)?;
        let water = water_in(&self.scene, parts, rows.fluid)?;
        let loads = loads_in(parts, rows.bodies)?;
        let origin = origin_in(parts)?;
        if origin.as_ref().is_some_and(|origin| origin.present != digest_of(&self.scene)) {
            return Err(invalid(SCENE, "it is of another scene"));
        }
        let rest: Rest =
            postcard::from_bytes(parts.of(REST)).map_err(|error| invalid(REST, error.to_string()))?;
        if let Some(defect) = rest.defect(self) {
            return Err(invalid(REST, defect));
        }
        let frame = self.frame_in(parts)?;
        let Rest { clock, step, gravity, constant, sleep, commands, fluid_forces } = rest;
        let places = SLEEP.map(|name| places(parts.of(name)));
        let sleep = self.sleep_from(sleep, rows, places, &commands.targets);
        let sleep = sleep.map_err(|reason| invalid("sleep", reason))?;
        let own = if self.has_own_engine { ENGINE_OF_HOST } else { ENGINE };
        // Without bodies an engine may have a clock all the same.
        if self.stores.host.rows.bodies > 0 || !parts.of(own).is_empty() {
            self.engine.restore(parts.of(own))?;
        }
        self.set_particles(rows.fluid)?;
        (self.water, self.frame, self.origin) = (water, frame, origin);
        for column in saved_columns() {
            take_column(&mut self.stores.host, column, parts.of(column.name()));
        }
        self.light.set_gravity(gravity);
        (self.clock, self.sleep, self.commands, self.failed) = (clock, sleep, commands, None);
        (self.params.gravity, self.params.step) = (gravity, step);
        self.follow_frame();
        self.loads.take(fluid_forces, &loads);
        if let Some(device) = &mut self.stores.device {
            device.discard_state();
        }
        self.resume_sleep(constant);
        Ok(())
    }

    /// Rows of a state: as many particles as have identities, and the rest as here.
    fn rows_in(&self, parts: &Parts<'_>) -> RowCounts {
        let own = self.stores.host.rows;
        if self.scene.fluid.is_none() {
            return own;
        }
        RowCounts { fluid: parts.of(Column::FluidId.name()).len() / 4, ..own }
    }

    /// The motion of the container, and gravity over time.
    fn frame_in(&self, parts: &Parts<'_>) -> Result<Option<Frame>, StateError> {
        let bytes = parts.of(CONTAINER);
        if bytes.is_empty() {
            return Ok(None);
        }
        let frame: Frame =
            postcard::from_bytes(bytes).map_err(|error| invalid(CONTAINER, error.to_string()))?;
        frame.defect(&self.scene).map_or(Ok(Some(frame)), |defect| Err(invalid(CONTAINER, defect)))
    }

    /// Refuses identities that occur twice, or that were never given.
    fn check_ids(&self, parts: &Parts<'_>, given: u64) -> Result<(), StateError> {
        let (words, _) = parts.of(Column::FluidId.name()).as_chunks::<4>();
        let mut ids: Vec<u32> = words.iter().map(|id| u32::from_le_bytes(*id)).collect();
        ids.sort_unstable();
        let is_twice = ids.windows(2).any(|pair| pair[0] == pair[1]);
        if is_twice || ids.last().is_some_and(|last| u64::from(*last) >= given) {
            return Err(invalid(Column::FluidId.name(), format!("not different identities below {given}")));
        }
        Ok(())
    }

    /// Refuses sections that are no columns of this scene, or of other sizes.
    fn check_sections(&self, parts: &Parts<'_>, rows: RowCounts) -> Result<(), StateError> {
        let columns = &self.stores.host;
        let known = |name: &str| {
            name == ENGINE
                || name == ENGINE_OF_HOST
                || name == REST
                || name == WATER
                || name == LOADS
                || name == CONTAINER
                || name == SCENE
                || SLEEP.contains(&name)
                || saved_columns().any(|column| column.name() == name)
        };
        if let Some((name, _)) = parts.0.iter().find(|(name, _)| !known(name)) {
            return Err(invalid(name, "this library has no such column"));
        }
        let other = if self.has_own_engine { ENGINE } else { ENGINE_OF_HOST };
        if self.stores.host.rows.bodies > 0 && parts.0.iter().any(|(name, _)| *name == other) {
            let reason = if self.has_own_engine {
                "its bodies were moved by an engine of the library, and those of this world are by one of the host"
            } else {
                "its bodies were moved by an engine of a host: `resume` it in a world of `World::with_engine`"
            };
            return Err(invalid(other, reason));
        }
        for column in saved_columns() {
            let bytes = parts.of(column.name()).len();
            if !fits(columns, rows, column, bytes) {
                let rows = rows.of(column.store());
                let row = column.element().bytes();
                return Err(invalid(column.name(), format!("{bytes} bytes for {rows} rows of {row} bytes")));
            }
        }
        self.check_ids(parts, water_in(&self.scene, parts, rows.fluid)?.identities())?;
        let holds = |body: u32| body == u32::MAX || (body as usize) < columns.rows.bodies;
        let mut grips = parts.of(Column::NodeGrip.name()).as_chunks::<4>().0.iter();
        match grips.find(|grip| !holds(u32::from_le_bytes(**grip))) {
            Some(grip) => {
                let body = u32::from_le_bytes(*grip);
                Err(invalid(Column::NodeGrip.name(), format!("there is no body of number {body}")))
            }
            None => Ok(()),
        }
    }
}

/// Which scene a state began with, if commands have changed that.
pub(super) fn origin_in(parts: &Parts<'_>) -> Result<Option<Origin>, StateError> {
    let bytes = parts.of(SCENE);
    if bytes.is_empty() {
        return Ok(None);
    }
    postcard::from_bytes(bytes).map(Some).map_err(|error| invalid(SCENE, error.to_string()))
}

/// What pushed the bodies of a state beside the fluid.
fn loads_in(parts: &Parts<'_>, bodies: usize) -> Result<SavedLoads, StateError> {
    let bytes = parts.of(LOADS);
    if bytes.is_empty() {
        return Ok(SavedLoads::new());
    }
    let loads: SavedLoads = postcard::from_bytes(bytes).map_err(|error| invalid(LOADS, error.to_string()))?;
    if loads.len() != bodies {
        return Err(invalid(LOADS, format!("{} bodies, and there are {bodies}", loads.len())));
    }
    Ok(loads)
}

/// What commands have done to the water of a state of as many particles.
fn water_in(scene: &Scene, parts: &Parts<'_>, rows: usize) -> Result<Water, StateError> {
    let bytes = parts.of(WATER);
    if bytes.is_empty() {
        return Ok(Water::of_scene(scene, rows));
    }
    let water: Water = postcard::from_bytes(bytes).map_err(|error| invalid(WATER, error.to_string()))?;
    water.defect(rows).map_or(Ok(water), |defect| Err(invalid(WATER, defect)))
}

/// Positions from their bytes.
fn places(bytes: &[u8]) -> Vec<Vec3> {
    let place = |bytes: &[u8; 12]| {
        let mut words = [0_u32; 3];
        copy_words(bytes, &mut words);
        Vec3::from_array(words.map(f32::from_bits))
    };
    bytes.as_chunks::<12>().0.iter().map(place).collect()
}
