//! A picture prepared for drawing: finite values only, the middle and the size of the scene.

use super::camera::{Camera, Raster};
use super::shapes::Solid;
use super::sponge::Surface;
use super::{DrawnBody, Picture};
use glam::Vec3;

/// The floor of the container.
#[derive(Debug)]
pub(super) struct Floor {
    pub(super) height: f32,
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// Side of a square of the grid in m: 1, 2 or 5 times a power of ten.
    pub(super) pitch: f32,
}

/// A picture prepared for drawing.
pub(super) struct Stage<'a> {
    pub(super) picture: &'a Picture<'a>,
    pub(super) raster: Raster,
    /// Particles with a finite position: index in the list and position.
    pub(super) particles: Vec<(usize, Vec3)>,
    pub(super) radius: f32,
    pub(super) solids: Vec<Solid<'a>>,
    pub(super) sponge: Surface,
    pub(super) floor: Option<Floor>,
    /// Lowest and highest corner of a container (m).
    pub(super) container: Option<(Vec3, Vec3)>,
    /// Lowest and highest corner of the box around the drawn items (m).
    pub(super) around: (Vec3, Vec3),
    /// Middle of the box around the drawn items, stabilised by the container: it must not jump between frames.
    pub(super) centre: Vec3,
    /// Diagonal of the box in m.
    pub(super) size: f32,
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
        let solid = |(index, body): (usize, &DrawnBody<'a>)| Solid::new(index, body);
        let solids: Vec<Solid<'a>> = picture.bodies.iter().enumerate().filter_map(solid).collect();
        let sponge = Surface::new(picture);
        let container = picture.container.map(|(a, b)| (a.min(b), a.max(b))).filter(|(a, b)| {
            let side = *b - *a;
            side.is_finite() && side.min_element() > 1e-6
        });
        let (low, high) = extent(&particles, radius, &solids, &sponge, container);
        let height_scale = container.map_or(40.0 * radius, |(a, b)| b.y - a.y).max(1e-6);
        let floor = container.map(|(low, high)| {
            let side = (high - low).max_element().max(1e-6);
            Floor { height: low.y, low, high, pitch: round_pitch(side / 10.0) }
        });
        let raster = Raster::new(camera, width, height);
        let (centre, size) = ((low + high) * 0.5, (high - low).length());
        let fast = 0.75 * (2.0 * 9.81 * height_scale).sqrt();
        let around = (low, high);
        Self {
            picture,
            raster,
            particles,
            radius,
            solids,
            sponge,
            floor,
            container,
            around,
            centre,
            size,
            fast,
        }
    }

    /// Height of the floor (m), with the plane that it is if a body is: the floor of the container, or the highest level plane.
    pub(super) fn ground(&self) -> Option<(f32, Option<usize>)> {
        if let Some(floor) = &self.floor {
            return Some((floor.height, None));
        }
        let level = |index: &usize| {
            let solid = &self.solids[*index];
            solid.is_plane() && solid.rotation.y_axis.y > 0.9999
        };
        let height = |index: usize| self.solids[index].position.y;
        let highest = (0..self.solids.len()).filter(level).max_by(|a, b| height(*a).total_cmp(&height(*b)));
        highest.map(|index| (height(index), Some(index)))
    }

    /// Lowest and highest corner of the box that the scene is in (m): the container, so that nothing jumps when something flies
    /// out of it.
    pub(super) fn frame(&self) -> (Vec3, Vec3) {
        self.container.unwrap_or(self.around)
    }

    /// Side of a tile of the floor (m).
    pub(super) fn pitch(&self) -> f32 {
        let (low, high) = self.frame();
        round_pitch((high - low).max_element().max(1e-6) / 14.0)
    }

    /// Share of a particle that a sponge holds, 0 to 1.
    pub(super) fn interior(&self, particle: usize) -> f32 {
        self.picture.interior.get(particle).copied().unwrap_or(0.0)
    }

    /// Distance from the scene's centre where the ground begins to fade into the sky.
    pub(super) fn fade_start(&self) -> f32 {
        0.6 * self.size
    }

    /// Distance from the scene's centre where it has faded completely.
    pub(super) fn fade_end(&self) -> f32 {
        2.6 * self.size
    }

    /// Speed of a particle, 0 (still) to 1 (as fast as a fall through the scene).
    pub(super) fn speed(&self, particle: usize) -> f32 {
        let Some(&[x, y, z, _]) = self.picture.velocities.get(particle) else {
            return 0.0;
        };
        let speed = Vec3::new(x, y, z).length() / self.fast;
        if speed.is_finite() { speed.min(1.0) } else { 0.0 }
    }
}

/// Box around everything that can be drawn, except planes; not empty.
fn extent(
    particles: &[(usize, Vec3)],
    radius: f32,
    solids: &[Solid<'_>],
    sponge: &Surface,
    container: Option<(Vec3, Vec3)>,
) -> (Vec3, Vec3) {
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
    let Some((a, b)) = container else {
        let usable = low.is_finite() && high.is_finite();
        return if usable { (low, high.max(low + 1e-6)) } else { (Vec3::splat(-0.5), Vec3::splat(0.5)) };
    };
    // Stray particles do not stretch the box beyond one container on each side, and it grows in steps of a quarter.
    let side = (b - a).max(Vec3::splat(1e-6));
    let steps = |distance: Vec3| ((distance / side * 4.0).ceil() * 0.25).clamp(Vec3::ZERO, Vec3::ONE) * side;
    (a - steps(a - low.min(a)), a + side + steps(high.max(b) - b))
}

/// 1, 2 or 5 times a power of ten, at most slightly above `length`.
fn round_pitch(length: f32) -> f32 {
    let power = 10.0_f32.powf(length.log10().floor());
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
