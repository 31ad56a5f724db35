//! What fluid and sponges give a body in a step.

use glam::DVec3;

use crate::cpu::CHUNK;

/// Impulses of fluid and sponges on a body in one step, summed in f64 in a fixed order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Impulse \[N s\].
    pub impulse: DVec3,
    /// Angular impulse about the centre of mass \[N m s\].
    pub angular_impulse: DVec3,
}

impl Wrench {
    /// Adds an impulse at a point given relative to the centre of mass.
    pub fn add(&mut self, impulse: DVec3, arm: DVec3) {
        self.impulse += impulse;
        self.angular_impulse += arm.cross(impulse);
    }
}

/// A wrench without impulses for every chunk of rows and every body.
pub(crate) fn begin(wrenches: &mut Vec<Wrench>, rows: usize, bodies: usize) {
    wrenches.clear();
    wrenches.resize(rows.div_ceil(CHUNK) * bodies, Wrench::default());
}

/// The impulses of every chunk of rows on every body; chunks beyond the given number are left out.
pub(crate) fn by_chunk(wrenches: &mut [Wrench], chunks: usize, bodies: usize) -> Vec<&mut [Wrench]> {
    match bodies {
        0 => (0..chunks).map(|_| &mut [][..]).collect(),
        count => wrenches.chunks_exact_mut(count).take(chunks).collect(),
    }
}
