//! What a step, a frame and a state are like.

use glam::DVec3;
use sorb::glam;

use crate::{
    failure::{Failure, Status, entry},
    memory::{given, versioned, write_sized},
    world::World,
};

/// Result of a step.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct StepReport {
    /// `sizeof(sorb_step_report)`.
    pub size: usize,
    /// Time after the step (s).
    pub time: f64,
    /// Length of the step (s).
    pub step: f32,
    /// Largest speed of particles and nodes after the step (m/s).
    pub maximum_speed: f32,
}

/// Result of a frame.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct FrameReport {
    /// `sizeof(sorb_frame_report)`.
    pub size: usize,
    /// Time after the frame (s).
    pub time: f64,
    /// Steps of the frame.
    pub steps: u32,
    /// Shortest step of the frame (s); infinite if there was none.
    pub shortest_step: f32,
    /// Largest speed of particles and nodes in the frame (m/s).
    pub maximum_speed: f32,
}

/// Simulated time.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Clock {
    /// `sizeof(sorb_clock)`.
    pub size: usize,
    /// Time since the start (s).
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// Frames completed.
    pub frames: u64,
}

/// Masses, momenta, energies and errors of a state.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Measures {
    /// `sizeof(sorb_measures)`.
    pub size: usize,
    /// Simulated time (s).
    pub time: f64,
    /// Mass of all water (kg).
    pub water_mass: f64,
    /// Mass of the water inside sponges (kg).
    pub absorbed_mass: f64,
    /// Water-filled pore volume over pore volume at rest (1).
    pub saturation: f64,
    /// Height of the highest node that is more than half saturated, above the lowest node (m).
    pub wicking_height: f64,
    /// Volume of all sponges (m^3), pores included.
    pub sponge_volume: f64,
    /// Centre of mass of the dry sponges (m).
    pub sponge_centre: [f64; 3],
    /// Momentum of water, sponges and bodies (kg m/s).
    pub linear_momentum: [f64; 3],
    /// Angular momentum about the origin (kg m^2/s).
    pub angular_momentum: [f64; 3],
    /// Kinetic energy (J).
    pub kinetic_energy: f64,
    /// Potential energy in the gravity field, zero at the origin (J).
    pub potential_energy: f64,
    /// Elastic energy of the sponges (J).
    pub elastic_energy: f64,
    /// Largest speed of particles and nodes (m/s).
    pub maximum_speed: f64,
    /// Mean of max(density / rest density - 1, 0) over the particles (1).
    pub mean_density_error: f64,
    /// Largest density / rest density - 1, at least zero (1).
    pub maximum_density_error: f64,
}

/// Where all water came from and went, in particles.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Ledger {
    /// `sizeof(sorb_ledger)`.
    pub size: usize,
    /// Those that the scene began with.
    pub seeded: u64,
    /// Those that were poured, by commands and by emitters.
    pub poured: u64,
    /// Those that were removed.
    pub removed: u64,
    /// Those that drains have taken.
    pub drained: u64,
    /// Those that are there.
    pub present: u64,
    /// Those of the present ones that sponges hold.
    pub absorbed: u64,
    /// Places of pours in which there was no room.
    pub left_out: u64,
    /// Always 0.
    pub lost: i64,
    /// Mass of a particle (kg); 0 without fluid.
    pub particle_mass: f32,
}

versioned! {
    StepReport "sorb_step_report",
    FrameReport "sorb_frame_report",
    Clock "sorb_clock",
    Measures "sorb_measures",
    Ledger "sorb_ledger",
}

impl From<sorb::StepReport> for StepReport {
    fn from(report: sorb::StepReport) -> Self {
        let sorb::StepReport { time, step, maximum_speed, .. } = report;
        Self { size: 0, time, step, maximum_speed }
    }
}

impl From<sorb::FrameReport> for FrameReport {
    fn from(report: sorb::FrameReport) -> Self {
        let sorb::FrameReport { time, steps, shortest_step, maximum_speed, .. } = report;
        Self { size: 0, time, steps, shortest_step, maximum_speed }
    }
}

/// Simulated time, steps and frames.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_clock(world: Option<&World>, clock: *mut Clock) -> Status {
    entry(|| {
        let sorb::Clock { time, steps, frames, .. } = *given(world, "world")?.read()?.clock();
        // SAFETY: the promise of the caller.
        unsafe { write_sized(clock, &Clock { size: 0, time, steps, frames }) }
    })
}

/// Masses, momenta, energies and errors of the present state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_measures(world: Option<&World>, measures: *mut Measures) -> Status {
    entry(|| {
        let own = measures_of(given(world, "world")?)?;
        // SAFETY: the promise of the caller.
        unsafe { write_sized(measures, &own) }
    })
}

fn measures_of(world: &World) -> Result<Measures, Failure> {
    let own = world.read()?.measures();
    Ok(Measures {
        size: 0,
        time: own.time,
        water_mass: own.water_mass,
        absorbed_mass: own.absorbed_mass,
        saturation: own.saturation,
        wicking_height: own.wicking_height,
        sponge_volume: own.sponge_volume,
        sponge_centre: DVec3::to_array(&own.sponge_centre),
        linear_momentum: own.linear_momentum.to_array(),
        angular_momentum: own.angular_momentum.to_array(),
        kinetic_energy: own.kinetic_energy,
        potential_energy: own.potential_energy,
        elastic_energy: own.elastic_energy,
        maximum_speed: own.maximum_speed,
        mean_density_error: own.mean_density_error,
        maximum_density_error: own.maximum_density_error,
    })
}

/// Where all water came from and went.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_ledger(world: Option<&World>, ledger: *mut Ledger) -> Status {
    entry(|| {
        let own = given(world, "world")?.read()?.ledger();
        let own = Ledger {
            size: 0,
            seeded: own.seeded,
            poured: own.poured,
            removed: own.removed,
            drained: own.drained,
            present: own.present,
            absorbed: own.absorbed,
            left_out: own.left_out,
            lost: own.lost,
            particle_mass: own.particle_mass,
        };
        // SAFETY: the promise of the caller.
        unsafe { write_sized(ledger, &own) }
    })
}
