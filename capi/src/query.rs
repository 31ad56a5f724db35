//! Questions about the present state.

use sorb::{Targets, glam::Vec3};

use crate::{
    failure::{Fails, Failure, Status, entry},
    memory::{check_room, elements, fill, given},
    world::World,
};

/// A ray.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Ray {
    /// Where it begins, -1000 to 1000 m.
    pub origin: [f32; 3],
    /// Its direction, of any length but zero.
    pub direction: [f32; 3],
    /// Its length, 0 to 2000 m.
    pub length: f32,
}

/// What rays may meet: a sum of these.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum Target {
    /// Rigid bodies.
    Bodies = 1,
    /// The outer surfaces of sponges.
    Sponges = 2,
    /// The surface of the water, also that in sponges.
    Water = 4,
    /// Everything.
    All = 7,
}

/// What a ray has met.
#[derive(Clone, Copy, Debug)]
#[repr(u32)]
pub enum Surface {
    /// Nothing.
    None = 0,
    /// A body.
    Body = 1,
    /// A sponge.
    Sponge = 2,
    /// Water.
    Water = 3,
}

/// Where a ray meets something; zeros if it meets nothing.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Hit {
    /// Distance from the origin of the ray (m).
    pub distance: f32,
    /// The place (m).
    pub point: [f32; 3],
    /// Outward normal of the surface there, of unit length.
    pub normal: [f32; 3],
    /// What it is: a `sorb_surface`.
    pub surface: u32,
    /// Number of the body or the sponge in the scene.
    pub number: u32,
}

/// What is at a point.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Probe {
    /// Share of the space around the point that is water, about 0 to 1.
    pub filled: f32,
    /// Mass of water over space around the point (kg/m^3).
    pub density: f32,
    /// Mean velocity of the water around the point (m/s); zero where there is none.
    pub velocity: [f32; 3],
    /// Mean pressure of the water around the point (Pa); zero where there is none.
    pub pressure: f32,
    /// Number of the sponge that the point lies in; -1 if it lies in none, and the rest is zero.
    pub sponge: i32,
    /// Water-filled pore volume over pore volume there, about 0 to 1.
    pub saturation: f32,
    /// Pressure of the water in the pores (Pa).
    pub pore_pressure: f32,
    /// Velocity of the sponge there (m/s).
    pub sponge_velocity: [f32; 3],
    /// Volume of the sponge there over that at rest (1).
    pub volume_ratio: f32,
}

/// What every ray meets first. `targets` is a sum of `sorb_target`; `hits` has room for `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_cast_rays(
    world: Option<&World>,
    rays: *const Ray,
    count: usize,
    targets: u32,
    hits: *mut Hit,
) -> Status {
    entry(|| {
        let world = given(world, "world")?.read()?;
        // SAFETY: the promise of the caller.
        let rays = unsafe { elements(rays, count, "rays") }?;
        check_room(hits, count, "hits")?;
        let has = |target: Target| targets & target as u32 != 0;
        let met =
            Targets { bodies: has(Target::Bodies), sponges: has(Target::Sponges), water: has(Target::Water) };
        if targets & !(Target::All as u32) != 0 {
            let message = format!("targets = {targets} is out of range 0 to {}", Target::All as u32);
            return Err(Failure::new(Status::NoSuchThing, message));
        }
        let rays: Vec<sorb::Ray> = rays.iter().map(ray).collect();
        let found = world.cast_rays(&rays, met).fails(Status::Query)?;
        let found: Vec<Hit> = found.into_iter().map(|hit| hit.map_or_else(Hit::default, hit_of)).collect();
        // SAFETY: the promise of the caller: room for as many as there are rays.
        unsafe { fill(hits, &found) };
        Ok(())
    })
}

fn ray(ray: &Ray) -> sorb::Ray {
    let (origin, direction) = (Vec3::from_array(ray.origin), Vec3::from_array(ray.direction));
    sorb::Ray { origin, direction, length: ray.length }
}

fn hit_of(hit: sorb::Hit) -> Hit {
    let (surface, number) = match hit.surface {
        sorb::Surface::Body(number) => (Surface::Body, number),
        sorb::Surface::Sponge(number) => (Surface::Sponge, number),
        sorb::Surface::Water => (Surface::Water, 0),
        _ => (Surface::None, 0),
    };
    Hit {
        distance: hit.distance,
        point: hit.point.to_array(),
        normal: hit.normal.to_array(),
        surface: surface as u32,
        number: number as u32,
    }
}

/// Height of the highest surface of water at every place (m); NaN where there is no water. `places` has `count` times x and z (m);
/// `levels` has room for `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_water_levels(
    world: Option<&World>,
    places: *const f32,
    count: usize,
    levels: *mut f32,
) -> Status {
    entry(|| {
        let world = given(world, "world")?.read()?;
        // SAFETY: the promise of the caller.
        let places = unsafe { elements(places.cast::<[f32; 2]>(), count, "places") }?;
        check_room(levels, count, "levels")?;
        let found = world.water_levels(places).fails(Status::Query)?;
        let found: Vec<f32> = found.into_iter().map(|level| level.unwrap_or(f32::NAN)).collect();
        // SAFETY: the promise of the caller: room for as many as there are places.
        unsafe { fill(levels, &found) };
        Ok(())
    })
}

/// What is at every point. `points` has `count` times x, y and z (m); `probes` has room for `count`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sorb_world_probe(
    world: Option<&World>,
    points: *const f32,
    count: usize,
    probes: *mut Probe,
) -> Status {
    entry(|| {
        let world = given(world, "world")?.read()?;
        // SAFETY: the promise of the caller.
        let points = unsafe { elements(points.cast::<[f32; 3]>(), count, "points") }?;
        check_room(probes, count, "probes")?;
        let points: Vec<Vec3> = points.iter().map(|point| Vec3::from_array(*point)).collect();
        let found = world.probe(&points).fails(Status::Query)?;
        let found: Vec<Probe> = found.iter().map(probe_of).collect();
        // SAFETY: the promise of the caller: room for as many as there are points.
        unsafe { fill(probes, &found) };
        Ok(())
    })
}

fn probe_of(found: &sorb::Probe) -> Probe {
    let own = Probe {
        filled: found.filled,
        density: found.density,
        velocity: found.velocity.to_array(),
        pressure: found.pressure,
        sponge: -1,
        ..Probe::default()
    };
    let Some(sponge) = &found.sponge else { return own };
    Probe {
        sponge: i32::try_from(sponge.sponge).unwrap_or(i32::MAX),
        saturation: sponge.saturation,
        pore_pressure: sponge.pore_pressure,
        sponge_velocity: sponge.velocity.to_array(),
        volume_ratio: sponge.volume_ratio,
        ..own
    }
}
