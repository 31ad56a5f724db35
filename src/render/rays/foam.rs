//! The pores of the sponge: a periodic field of distances from their walls, made once in a program.

use crate::render::colour::unit;
use glam::{IVec3, Vec3};
use std::sync::LazyLock;

/// Texels along a side.
const SIDE: usize = 64;
/// Side of the field (m).
const PERIOD: f32 = 0.026;

#[cfg(feature = "gpu")]
shared_with_shaders!(FOAM: SIDE, PERIOD);
/// Number of pores in it.
const PORES: u32 = 620;

/// Distances from the walls of pores (mm), negative in a pore.
#[derive(Debug)]
pub(in crate::render) struct Foam {
    distances: Vec<f32>,
}

static FOAM: LazyLock<Foam> = LazyLock::new(Foam::new);

/// The foam of all sponges.
pub(in crate::render) fn foam() -> &'static Foam {
    &FOAM
}

impl Foam {
    fn new() -> Self {
        let period = PERIOD * 1e3;
        let texel = period / SIDE as f32;
        let mut distances = vec![10.0_f32; SIDE * SIDE * SIDE];
        for pore in 0..PORES {
            let random = |k: u32| unit(pore.wrapping_mul(16) + k);
            let centre = Vec3::new(random(0), random(1), random(2)) * period;
            // Many small pores, a few large ones.
            let size = random(3);
            let square = size * size;
            let radius = 0.45 + 1.75 * square * square * size + 0.5 * size;
            let stretch = Vec3::new(1.0, 0.8 + 0.4 * random(4), 0.8 + 0.4 * random(5));
            let reach = ((radius + 1.2) / texel).ceil() as i32;
            let middle = (centre / texel).floor().as_ivec3();
            for z in -reach..=reach {
                for y in -reach..=reach {
                    for x in -reach..=reach {
                        let at = middle + IVec3::new(x, y, z);
                        let offset = ((at.as_vec3() + 0.5) * texel - centre) * stretch;
                        let [x, y, z] = at.to_array().map(|place| place.rem_euclid(SIDE as i32) as usize);
                        let value = &mut distances[(z * SIDE + y) * SIDE + x];
                        *value = value.min(offset.length() - radius);
                    }
                }
            }
        }
        Self { distances }
    }

    /// All distances (mm), row by row.
    #[cfg(feature = "gpu")]
    pub(in crate::render) fn distances(&self) -> &[f32] {
        &self.distances
    }

    /// Distance from the wall of a pore (mm) at a place in the sponge at rest (m).
    pub(super) fn distance(&self, place: Vec3) -> f32 {
        // Shifted by whole periods, so that cutting rounds down.
        let at = place * (SIDE as f32 / PERIOD) + (64 * SIDE) as f32;
        let [x, y, z] = at.to_array().map(|place| place as i32);
        let f = at - Vec3::new(x as f32, y as f32, z as f32);
        let pair = |at: i32, stride: usize| [at, at + 1].map(|k| (k & (SIDE as i32 - 1)) as usize * stride);
        let (x, y, z) = (pair(x, 1), pair(y, SIDE), pair(z, SIDE * SIDE));
        let row = |y: usize, z: usize| {
            let (a, b) = (self.distances[z + y + x[0]], self.distances[z + y + x[1]]);
            a + (b - a) * f.x
        };
        let plane = |z: usize| {
            let (a, b) = (row(y[0], z), row(y[1], z));
            a + (b - a) * f.y
        };
        let (a, b) = (plane(z[0]), plane(z[1]));
        a + (b - a) * f.z
    }
}
