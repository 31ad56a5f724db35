//! Questions about the state on the device: points and rays go there, and answers of 32 bytes each come back.

use glam::{DVec3, Vec3};
use wgpu::{Buffer, BufferUsages, util::DeviceExt};

use super::{
    error::GpuError,
    layout::Value,
    program::Dispatch,
    query_layout::{NEAR_RAY, QueryAnswer, Question},
    resident::Resident,
    twins::{Pass, QUERY_POINTS, QUERY_RAYS, QUERY_SPONGES},
};

/// Rays of one dispatch, which share the room for particles near them.
const RAYS_AT_ONCE: u32 = 128;

/// How the space around a point is shared among the particles near it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterShares {
    /// How far away particles count \[m\].
    pub radius: f32,
    /// Share of the space that a particle fills at its place, before the smoothing function \[1\].
    pub scale: f32,
    /// Way along a ray between two looks \[m\].
    pub step: f32,
}

/// Sums over the water around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WaterSums {
    /// Shares of the particles \[1\].
    pub share: f64,
    /// Shares of the particles and of their images behind walls \[1\].
    pub filled: f64,
    /// Sum of share times the lane of the pressure \[m^2/s^2\].
    pub pressure: f64,
    /// Sum of share times velocity \[m/s\].
    pub velocity: DVec3,
}

/// What a sponge is like at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpongeValues {
    /// Its number.
    pub sponge: usize,
    /// Water-filled pore volume over pore volume \[1\].
    pub saturation: f32,
    /// Six times the volume of the tet there \[m^3\].
    pub volume: f32,
    /// Velocity of the material \[m/s\].
    pub velocity: Vec3,
}

/// Where a ray meets water: distance \[m\] and outward normal.
pub type WaterHit = Option<(f32, Vec3)>;

impl Resident {
    /// The water around points; `shares` says how far around.
    ///
    /// # Errors
    /// The device was lost, or there is no memory for the points.
    pub fn water_around(&self, points: &[Vec3], shares: &WaterShares) -> Result<Vec<WaterSums>, GpuError> {
        let sums = |QueryAnswer { a, b }: QueryAnswer| WaterSums {
            share: a[0].into(),
            filled: a[1].into(),
            pressure: a[2].into(),
            velocity: DVec3::new(b[0].into(), b[1].into(), b[2].into()),
        };
        let answers = self.answers_at(&QUERY_POINTS, points, shares)?;
        Ok(answers.into_iter().map(sums).collect())
    }

    /// The sponges that points lie in.
    ///
    /// # Errors
    /// As [`Self::water_around`].
    pub fn sponges_at(&self, points: &[Vec3]) -> Result<Vec<Option<SpongeValues>>, GpuError> {
        let values = |QueryAnswer { a, b }: QueryAnswer| {
            (a[0] >= 0.0).then(|| SpongeValues {
                sponge: a[0] as usize,
                saturation: a[1],
                volume: a[2],
                velocity: Vec3::new(b[0], b[1], b[2]),
            })
        };
        let none = WaterShares { radius: 0.0, scale: 0.0, step: 0.0 };
        let answers = self.answers_at(&QUERY_SPONGES, points, &none)?;
        Ok(answers.into_iter().map(values).collect())
    }

    /// Where rays meet the surface of the water: origin, direction of unit length and length of each. None if more particles are near a
    /// ray than there is room for.
    ///
    /// # Errors
    /// As [`Self::water_around`].
    pub fn rays_on_water(
        &self,
        rays: &[(Vec3, Vec3, f32)],
        shares: &WaterShares,
    ) -> Result<Option<Vec<WaterHit>>, GpuError> {
        let row = |(origin, direction, length): &(Vec3, Vec3, f32)| {
            [origin.extend(*length).to_array(), direction.extend(0.0).to_array()]
        };
        let rows: Vec<[f32; 4]> = rays.iter().flat_map(row).collect();
        let (asked, answers) = (self.asked(&rows)?, self.room("answers", QueryAnswer::BYTES, rays.len())?);
        let at_once = RAYS_AT_ONCE.min(rays.len() as u32);
        let near = self.room("particles near rays", 16, at_once as usize * NEAR_RAY as usize)?;
        let mut dispatches = Vec::new();
        for first in (0..rays.len() as u32).step_by(RAYS_AT_ONCE as usize) {
            let question = self.question(rays.len(), first, shares)?;
            let own =
                [("question", &question), ("asked", &asked), ("answers", &answers), ("near_ray", &near)];
            dispatches.push(self.bind_query(&QUERY_RAYS, at_once.into(), &own)?);
        }
        let answers = self.answered(&dispatches, &answers, rays.len())?;
        if answers.iter().any(|answer| answer.a[1] > NEAR_RAY as f32) {
            return Ok(None);
        }
        let hit = |QueryAnswer { a, b }: QueryAnswer| {
            let normal = Vec3::new(b[0], b[1], b[2]).normalize_or(Vec3::Y);
            (a[0] >= 0.0).then_some((a[0], normal))
        };
        Ok(Some(answers.into_iter().map(hit).collect()))
    }

    fn answers_at(
        &self,
        pass: &Pass,
        points: &[Vec3],
        shares: &WaterShares,
    ) -> Result<Vec<QueryAnswer>, GpuError> {
        let rows: Vec<[f32; 4]> = points.iter().map(|point| point.extend(0.0).to_array()).collect();
        let (asked, answers) = (self.asked(&rows)?, self.room("answers", QueryAnswer::BYTES, points.len())?);
        let question = self.question(points.len(), 0, shares)?;
        let own = [("question", &question), ("asked", &asked), ("answers", &answers)];
        let dispatch = self.bind_query(pass, points.len() as u64, &own)?;
        self.answered(&[dispatch], &answers, points.len())
    }

    fn question(&self, count: usize, first: u32, shares: &WaterShares) -> Result<Buffer, GpuError> {
        let WaterShares { radius, scale, step } = *shares;
        self.uniform("question", &Question { count: count as u32, first, radius, scale, step })
    }

    /// A buffer of points or rays.
    fn asked(&self, rows: &[[f32; 4]]) -> Result<Buffer, GpuError> {
        self.gpu.guarded(Some(("points or rays", 16 * rows.len() as u64)), || {
            self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("asked"),
                contents: bytemuck::cast_slice(rows),
                usage: BufferUsages::STORAGE,
            })
        })
    }

    /// A buffer for rows that a pass writes.
    fn room(&self, name: &'static str, bytes: u64, rows: usize) -> Result<Buffer, GpuError> {
        let size = bytes * rows as u64;
        let maximum = self.gpu.limits.max_storage_buffer_binding_size;
        if size > maximum {
            let reason = format!("the adapter binds at most {maximum} bytes");
            return Err(GpuError::OutOfMemory { buffer: name, needed: size, reason });
        }
        self.gpu.guarded(Some((name, size)), || {
            let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
            let descriptor =
                wgpu::BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
            self.gpu.device.create_buffer(&descriptor)
        })
    }

    /// A pass with a group for every point or ray.
    fn bind_query(&self, pass: &Pass, groups: u64, own: &[(&str, &Buffer)]) -> Result<Dispatch, GpuError> {
        let mut jobs = self.jobs("query", pass);
        jobs.iter_mut().for_each(|job| job.groups = self.lines(groups));
        let dispatch = self.bind_all(&jobs, own)?.pop();
        dispatch.ok_or_else(|| GpuError::Refused { reason: "a pass without rows".to_owned() })
    }

    /// Runs passes, and reads their answers.
    fn answered(
        &self,
        dispatches: &[Dispatch],
        answers: &Buffer,
        count: usize,
    ) -> Result<Vec<QueryAnswer>, GpuError> {
        self.submit(&[dispatches], false, None)?;
        let words = self.read_buffers(&[(answers, QueryAnswer::BYTES * count as u64)])?.concat();
        Ok(words.chunks_exact(QueryAnswer::WORDS).map(QueryAnswer::take).collect())
    }
}
