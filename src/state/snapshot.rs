//! A copy of a state in memory, to roll back to.

use sorb_kernels::{
    asleep::Asleep,
    columns::{Columns, RowCounts},
};

use std::sync::Arc;

use super::error::StateError;
use crate::{
    clock::{Clock, Steps},
    command::Commands,
    rigid::RigidEngine,
    scene::Scene,
    water::Water,
    world::{Origin, StepError, World, digest_of, forces::Loads, frame::Frame, sleep::Sleep},
};

/// The state of a world at some time, in memory. Filled again and again, it allocates for the columns only once; the engine
/// of the bodies is copied anew every time.
#[derive(Debug, Default)]
pub struct Snapshot(Option<Box<Kept>>);

#[derive(Debug)]
struct Kept {
    columns: Columns,
    engine: Box<dyn RigidEngine>,
    clock: Clock,
    sleep: Sleep,
    steps: Steps,
    asleep: Asleep,
    commands: Commands,
    loads: Loads,
    step: f32,
    gravity: glam::Vec3,
    failed: Option<StepError>,
    water: Water,
    frame: Option<Frame>,
    scene: Arc<Scene>,
    origin: Option<Origin>,
}

impl Snapshot {
    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The clock of the state; none while it is empty.
    #[must_use]
    pub fn clock(&self) -> Option<&Clock> {
        self.0.as_ref().map(|kept| &kept.clock)
    }
}

impl World {
    /// Copies the state into a snapshot. On a GPU the state is read back.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use sorb::{Snapshot, World, scene::Scene};
    ///
    /// let mut world = World::new(&Scene::new("space"))?;
    /// let mut snapshot = Snapshot::new();
    /// world.snapshot_into(&mut snapshot);
    /// let before = world.digest();
    /// world.step()?;
    /// world.rollback(&snapshot)?;
    /// assert_eq!(world.digest(), before);
    /// # Ok(())
    /// # }
    /// ```
    pub fn snapshot_into(&self, snapshot: &mut Snapshot) {
        let Some(kept) = &mut snapshot.0 else {
            let mut columns = Columns::default();
            columns.copy_state(self.columns());
            snapshot.0 = Some(Box::new(Kept {
                columns,
                engine: self.engine.clone(),
                clock: self.clock,
                sleep: self.sleep.clone(),
                steps: self.steps.clone(),
                asleep: self.params.asleep.clone(),
                commands: self.commands.clone(),
                loads: self.loads.clone(),
                step: self.params.step,
                gravity: self.params.gravity,
                failed: self.failed.clone(),
                water: self.water.clone(),
                frame: self.frame.clone(),
                scene: Arc::clone(&self.scene),
                origin: self.origin.clone(),
            }));
            return;
        };
        kept.columns.copy_state(self.columns());
        copy_engine(&mut kept.engine, &*self.engine);
        kept.sleep.copy(&self.sleep);
        kept.commands.copy(&self.commands);
        kept.loads.copy(&self.loads);
        (kept.clock, kept.steps) = (self.clock, self.steps.clone());
        kept.asleep.clone_from(&self.params.asleep);
        (kept.step, kept.gravity) = (self.params.step, self.params.gravity);
        kept.failed.clone_from(&self.failed);
        kept.water.clone_from(&self.water);
        kept.frame.clone_from(&self.frame);
        kept.scene = Arc::clone(&self.scene);
        kept.origin.clone_from(&self.origin);
    }

    /// Returns to the state of a snapshot of this world, or of another of the same scene: it continues with the same bits.
    ///
    /// # Errors
    /// The snapshot is empty, or of a scene with other numbers of nodes or bodies.
    pub fn rollback(&mut self, snapshot: &Snapshot) -> Result<(), StateError> {
        let fail =
            |reason: &str| StateError::Invalid { what: "snapshot".to_owned(), reason: reason.to_owned() };
        let Some(kept) = &snapshot.0 else { return Err(fail("it is empty")) };
        let is_changed = self.origin.is_some() || kept.origin.is_some();
        if is_changed && !Arc::ptr_eq(&self.scene, &kept.scene) && self.scene != kept.scene {
            let first = |origin: &Option<Origin>, scene: &Scene| {
                origin.as_ref().map_or_else(|| digest_of(scene), |origin| origin.first)
            };
            if first(&self.origin, &self.scene) != first(&kept.origin, &kept.scene) {
                return Err(fail("it is of another scene"));
            }
            // Commands have changed the scene since.
            *self = self.of_scene(&kept.scene, kept.origin.clone())?;
        }
        let RowCounts { fluid, .. } = kept.columns.rows;
        // Water may have come and gone since.
        let is_same = kept.columns.rows == RowCounts { fluid, ..self.stores.host.rows };
        if !is_same || fluid > 0 && self.scene.fluid.is_none() {
            return Err(fail("it is of another scene"));
        }
        self.set_particles(fluid)?;
        self.stores.host.copy_state(&kept.columns);
        copy_engine(&mut self.engine, &*kept.engine);
        self.sleep.copy(&kept.sleep);
        self.commands.copy(&kept.commands);
        self.loads.copy(&kept.loads);
        (self.clock, self.steps) = (kept.clock, kept.steps.clone());
        (self.params.step, self.params.gravity) = (kept.step, kept.gravity);
        self.light.set_gravity(kept.gravity);
        self.failed.clone_from(&kept.failed);
        self.water.clone_from(&kept.water);
        self.frame.clone_from(&kept.frame);
        self.origin.clone_from(&kept.origin);
        self.params.asleep.clone_from(&kept.asleep);
        if let Some(device) = &mut self.stores.device {
            device.discard_state();
        }
        self.leave_out(&self.sleep.dormant());
        Ok(())
    }
}

/// In place where the engine can, else as a new copy.
fn copy_engine(own: &mut Box<dyn RigidEngine>, from: &dyn RigidEngine) {
    if !own.copy_from(from) {
        *own = from.boxed_clone();
    }
}
