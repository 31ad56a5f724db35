//! Water that commands pour and remove.

use glam::Vec3;
use sorb_kernels::{
    contents::Contents,
    step::{POROUS_STEP, STEP},
};

use super::{
    StepError, World, WorldError, build::ROWS_FOR_THREADS, fastest, moving::column_pressure, sleep::Kind,
};
use crate::{
    command::Region,
    scene::MAXIMUM_PARTICLES,
    schedule::Plans,
    setup::jitter,
    state::StateError,
    water::{Ledger, Room, ranks},
};

impl World {
    /// Where all water came from and went, in particles. On a GPU the state is read back.
    ///
    /// ```
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// use sorb::{Command, Region, World, glam::Vec3, scene::{Fluid, Scene}};
    ///
    /// let (low, high) = (Vec3::splat(-0.05), Vec3::splat(0.05));
    /// let mut world = World::new(&Scene::new("cup").in_box(low, high).with_fluid(Fluid::default()))?;
    /// let region = Region::Sphere { centre: Vec3::ZERO, radius: 0.03 };
    /// world.push(Command::Pour { region, velocity: Vec3::ZERO })?;
    /// world.advance_frame()?;
    /// let ledger = world.ledger();
    /// assert!(ledger.poured > 0 && ledger.present == ledger.poured && ledger.lost == 0);
    /// # Ok(())
    /// # }
    /// ```
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        let water = &self.water;
        let (columns, particle_mass) = (self.columns(), self.params.fluid.particle_mass);
        let present = columns.rows.fluid as u64;
        let inside = columns.fluid.interior.iter().take(columns.rows.fluid);
        Ledger {
            particle_mass,
            seeded: water.seeded,
            poured: water.poured,
            removed: water.removed,
            drained: water.drained,
            present,
            absorbed: inside.filter(|interior| **interior > sorb_kernels::params::INSIDE).count() as u64,
            left_out: water.left_out,
            lost: (water.identities() - water.removed - water.drained) as i64 - present as i64,
        }
    }

    /// Makes room for as many particles as there will be at most: until then pours allocate nothing in the columns. On a GPU it
    /// makes room on the host only. At most for 50 million.
    pub fn reserve_particles(&mut self, particles: usize) {
        self.stores.host.reserve_fluid(particles.min(MAXIMUM_PARTICLES as usize));
    }

    /// Pours water where there is room.
    pub(super) fn pour(&mut self, region: &Region, velocity: Vec3) -> Result<(), StepError> {
        let room = self.room(region);
        self.add_water(&room, |_| velocity)
    }

    /// Adds water where there is room, with the velocity of each of the places that were asked for.
    pub(super) fn add_water(
        &mut self,
        room: &Room,
        velocity: impl Fn(usize) -> Vec3,
    ) -> Result<(), StepError> {
        self.water.left_out += room.left_out();
        let first = self.water.identities();
        // Identities are words, the last of which is that of padding.
        let free = u64::from(u32::MAX).saturating_sub(first) as usize;
        let points = &room.points[..room.points.len().min(free)];
        self.water.left_out += (room.points.len() - points.len()) as u64;
        if points.is_empty() {
            return Ok(());
        }
        let (columns, spacing) = (&mut self.stores.host, self.params.fluid.spacing);
        let before = columns.rows.fluid;
        columns.set_fluid_rows(before + points.len());
        let new = before..before + points.len();
        let places = room.places.iter().zip(points);
        for (row, ((asked, point), id)) in new.clone().zip(places.zip(first..)) {
            let place = *point + jitter(id, spacing);
            columns.fluid.position[row] = place.extend(0.0).to_array();
            columns.fluid.velocity[row] = velocity(*asked).extend(0.0).to_array();
            columns.fluid.id[row] = id as u32;
        }
        self.water.poured += points.len() as u64;
        self.sleep.add_particles(&columns.fluid.position[new.clone()]);
        let clock = &mut self.clock;
        clock.fluid_speed = clock.fluid_speed.max(fastest(&columns.fluid.velocity[new.clone()]));
        clock.fluid_acceleration = clock.fluid_acceleration.max(self.params.gravity.length());
        if self.params.fluid.incompressible.is_some() {
            // As if it were at rest at once: the solve of the next step knows better.
            let held = Vec3::select(self.scene.periodic().into(), Vec3::ZERO, self.params.gravity);
            let pressure = column_pressure(&columns.fluid.position[new], held);
            clock.fluid_pressure = clock.fluid_pressure.max(pressure);
        }
        self.water_has_changed(before)
    }

    /// Removes the water in a region.
    pub(super) fn remove_water(&mut self, region: &Region) -> Result<(), StepError> {
        let taken = self.take_water(region, usize::MAX)?;
        self.water.removed += taken as u64;
        Ok(())
    }

    /// Takes particles out of a region, the first of them in the order of the rows; returns how many.
    pub(super) fn take_water(&mut self, region: &Region, most: usize) -> Result<usize, StepError> {
        let columns = &mut self.stores.host;
        let (before, mut left) = (columns.rows.fluid, most);
        let is_inside = region.inside();
        let stays = |row: &[f32; 4]| {
            let goes = left > 0 && is_inside(Vec3::new(row[0], row[1], row[2]));
            left -= usize::from(goes);
            !goes
        };
        let stays: Vec<bool> = columns.fluid.position[..before].iter().map(stays).collect();
        if !stays.contains(&false) {
            return Ok(0);
        }
        let mut stays_by_rank = vec![true; before];
        for (rank, stays) in ranks(&columns.fluid.id[..before]).into_iter().zip(&stays) {
            stays_by_rank[rank as usize] = *stays;
        }
        self.sleep.keep_particles(&stays_by_rank);
        columns.keep_fluid_rows(&stays);
        let taken = before - columns.rows.fluid;
        self.water_has_changed(before)?;
        Ok(taken)
    }

    /// What follows from another number of particles.
    fn water_has_changed(&mut self, before: usize) -> Result<(), StepError> {
        let count = self.stores.host.rows.fluid;
        if (before == 0) != (count == 0) {
            self.plan_anew().map_err(|error| StepError::Water(error.to_string()))?;
            if self.scene.time.sleep_after > 0.0 {
                // Water is a part of its own: everything wakes, and rest is detected anew.
                self.sleep = self.sleep.anew(&self.scene, &self.params, &self.commands.targets);
                self.apply_sleep();
            }
        }
        self.take_threads(count);
        if count == 0 {
            (self.clock.fluid_speed, self.clock.fluid_acceleration, self.clock.fluid_pressure) =
                (0.0, 0.0, 0.0);
        }
        self.wake_kinds(|kind| kind == Kind::Fluid);
        // Nor may a step leave out what the new water is beside.
        self.take_bounds();
        self.wake_what_is_reached();
        Ok(())
    }

    /// Takes the threads that few rows had no use for.
    fn take_threads(&mut self, particles: usize) {
        if particles as u64 >= ROWS_FOR_THREADS
            && let Some(cpu) = self.spare_cpu.take()
        {
            self.cpu = cpu;
        }
    }

    /// Makes room for the particles of another state, whose rows are taken over afterwards.
    pub(crate) fn set_particles(&mut self, count: usize) -> Result<(), StateError> {
        let before = self.stores.host.rows.fluid;
        if count == before {
            return Ok(());
        }
        self.stores.host.set_fluid_rows(count);
        self.take_threads(count);
        if (before == 0) != (count == 0) {
            self.plan_anew().map_err(|error| StateError::World(Box::new(error)))?;
        }
        Ok(())
    }

    /// Plans the steps for the present contents, and places them anew.
    pub(crate) fn plan_anew(&mut self) -> Result<(), WorldError> {
        let step = if self.params.solid.is_some() { POROUS_STEP } else { STEP };
        let contents = Contents::new(&self.params, &self.stores.host);
        self.plans = Plans::new(step, &contents, &self.observed)?;
        self.runner.follow(&self.plans.0);
        self.place_again()
    }
}
