//! A picture prepared for drawing: finite values only, and the size of the scene.

use super::camera::{Camera, Raster};
use super::shapes::Solid;
use super::sponge::Surface;
use super::{DrawnBody, Picture};
use super::{View, water};
use glam::Vec3;

/// A picture prepared for drawing.
pub(super) struct Stage<'a> {
    pub(super) picture: &'a Picture<'a>,
    pub(super) raster: Raster,
    /// Particles with a finite position: index in the list and position.
    pub(super) particles: Vec<(usize, Vec3)>,
    /// How much of each of them is free water, 0 to 1; 1 for views without a surface.
    pub(super) free: Vec<f32>,
    pub(super) radius: f32,
    pub(super) solids: Vec<Solid<'a>>,
    pub(super) sponge: Surface,
    /// Lowest and highest corner of a container (m).
    pub(super) container: Option<(Vec3, Vec3)>,
    /// Lowest and highest corner of the box that the scene is in (m): the container, so that nothing jumps when something flies
    /// out of it.
    pub(super) around: (Vec3, Vec3),
    /// Speed of the palest water, m/s.
    pub(super) fast: f32,
}

impl<'a> Stage<'a> {
    pub(super) fn new(picture: &'a Picture<'a>, camera: &Camera, width: usize, height: usize) -> Self {
        let radius = picture.particle_radius;
        let drawable = radius > 0.0 && radius.is_finite();
        let particles: Vec<(usize, Vec3)> = picture
            .particles
            .iter()
            .map(|&[x, y, z, _]| Vec3::new(x, y, z))
            .enumerate()
            .filter(|(_, p)| drawable && p.is_finite())
            .collect();
        let sponge = Surface::new(picture);
        let free = if matches!(picture.view, View::Realistic | View::Superimposed | View::Fast) {
            let positions: Vec<Vec3> = particles.iter().map(|(_, place)| *place).collect();
            let held = |index: usize| picture.interior.get(index).copied().unwrap_or(0.0);
            let interior: Vec<f32> = particles.iter().map(|(index, _)| held(*index)).collect();
            water::free(&positions, &interior, &sponge, 2.0 * radius)
        } else {
            vec![1.0; particles.len()]
        };
        let solid = |(index, body): (usize, &DrawnBody<'a>)| Solid::new(index, body);
        let solids: Vec<Solid<'a>> = picture.bodies.iter().enumerate().filter_map(solid).collect();
        let container = container(picture);
        let around = container.unwrap_or_else(|| extent(&particles, radius, &solids, &sponge));
        let height_scale = container.map_or(40.0 * radius, |(a, b)| b.y - a.y).max(1e-6);
        let raster = Raster::new(camera, width, height);
        let fast = 0.75 * (2.0 * 9.81 * height_scale).sqrt();
        Self { picture, raster, particles, free, radius, solids, sponge, container, around, fast }
    }

    /// Height of the floor (m), with the plane that it is if a body is: the floor of the container, or the highest level plane.
    pub(super) fn ground(&self) -> Option<(f32, Option<usize>)> {
        if let Some((low, _)) = self.container {
            return Some((low.y, None));
        }
        let level = |index: &usize| {
            let solid = &self.solids[*index];
            solid.is_plane() && solid.rotation.y_axis.y > 0.9999
        };
        let height = |index: usize| self.solids[index].position.y;
        let highest = (0..self.solids.len()).filter(level).max_by(|a, b| height(*a).total_cmp(&height(*b)));
        highest.map(|index| (height(index), Some(index)))
    }

    /// Side of a tile of the floor (m).
    pub(super) fn pitch(&self) -> f32 {
        let (low, high) = self.around;
        round_pitch((high - low).max_element().max(1e-6) / 14.0)
    }

    /// Speed of a particle (m/s).
    pub(super) fn velocity(&self, particle: usize) -> f32 {
        let velocity = self.picture.velocities.get(particle);
        velocity.map_or(0.0, |&[x, y, z, _]| Vec3::new(x, y, z).length())
    }

    /// Speed of a particle, 0 (still) to 1 (as fast as a fall through the scene).
    pub(super) fn speed(&self, particle: usize) -> f32 {
        let speed = self.velocity(particle) / self.fast;
        if speed.is_finite() { speed.min(1.0) } else { 0.0 }
    }
}

/// Lowest and highest corner of a container that can be drawn (m).
pub(super) fn container(picture: &Picture<'_>) -> Option<(Vec3, Vec3)> {
    picture.container.map(|(a, b)| (a.min(b), a.max(b))).filter(|(a, b)| {
        let side = *b - *a;
        side.is_finite() && side.min_element() > 1e-6
    })
}

/// Box around everything that can be drawn in an open scene, except planes; not empty. Its corners are at multiples of a power
/// of two, so that it seldom changes from picture to picture.
fn extent(particles: &[(usize, Vec3)], radius: f32, solids: &[Solid<'_>], sponge: &Surface) -> (Vec3, Vec3) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let mut grow = |p: Vec3, r: f32| {
        low = low.min(p - r);
        high = high.max(p + r);
    };
    for &(_, p) in particles {
        grow(p, radius);
    }
    for solid in solids.iter().filter(|solid| !solid.is_plane()) {
        grow(solid.position, solid.radius);
    }
    for &(_, corners) in &sponge.triangles {
        for i in corners {
            grow(sponge.positions[i], 0.0);
        }
    }
    let size = (high - low).max_element();
    if !(size > 0.0 && size.is_finite()) {
        return (Vec3::splat(-0.5), Vec3::splat(0.5));
    }
    let step = 0.25 * libm::exp2f(libm::log2f(size).ceil());
    ((low / step).floor() * step, (high / step).ceil() * step)
}

/// 1, 2 or 5 times a power of ten, at most slightly above `length`.
fn round_pitch(length: f32) -> f32 {
    let power = libm::powf(10.0, libm::log10f(length).floor());
    let lead = length / power;
    power
        * if lead < 1.5 {
            1.0
        } else if lead < 3.5 {
            2.0
        } else if lead < 7.5 {
            5.0
        } else {
            10.0
        }
}
