//! Results per chunk of rows, combined in the order of the chunks.

use glam::DVec3;

use crate::{
    body::Wrench,
    column::{ColumnData, take_rows},
};

/// Extremes for the bounds of the time step, over one chunk of rows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extreme {
    /// Largest squared speed \[m^2/s^2\].
    pub speed_squared: f32,
    /// Largest squared acceleration \[m^2/s^4\].
    pub acceleration_squared: f32,
    /// A row whose position or velocity is not finite, plus one; 0 if there is none.
    pub not_finite: u32,
}

/// Extremes over all chunks.
#[derive(Clone, Debug, Default)]
pub struct Extremes(pub Vec<Extreme>);

impl Extremes {
    /// The extremes over all rows.
    #[must_use]
    pub fn total(&self) -> Extreme {
        self.0.iter().fold(Extreme::default(), |total, chunk| Extreme {
            speed_squared: total.speed_squared.max(chunk.speed_squared),
            acceleration_squared: total.acceleration_squared.max(chunk.acceleration_squared),
            not_finite: if total.not_finite > 0 { total.not_finite } else { chunk.not_finite },
        })
    }
}

impl ColumnData for Extremes {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for extreme in &self.0 {
            visit(extreme.speed_squared.to_bits());
            visit(extreme.acceleration_squared.to_bits());
            visit(extreme.not_finite);
        }
    }
    fn take_words(&mut self, _rows: usize, words: &[u32]) -> bool {
        let count = self.0.len();
        take_rows(&mut self.0, count, words, 3, |own, words| {
            *own = Extreme {
                speed_squared: f32::from_bits(words[0]),
                acceleration_squared: f32::from_bits(words[1]),
                not_finite: words[2],
            };
        })
    }
    fn poison(&mut self) {
        self.0.fill(Extreme {
            speed_squared: f32::NAN,
            acceleration_squared: f32::NAN,
            not_finite: u32::MAX,
        });
    }
}

/// Wrenches on every body by every chunk of rows, `chunks x bodies`.
#[derive(Clone, Debug, Default)]
pub struct Wrenches(pub(crate) Vec<Wrench>);

impl Wrenches {
    /// Wrench on one body of `bodies`, summed over the chunks in order.
    #[must_use]
    pub fn total(&self, body: usize, bodies: usize) -> Wrench {
        let mut total = Wrench::default();
        for wrench in self.0.iter().skip(body).step_by(bodies.max(1)) {
            total.impulse += wrench.impulse;
            total.angular_impulse += wrench.angular_impulse;
        }
        total
    }
}

impl ColumnData for Wrenches {
    fn visit_words(&self, _rows: usize, visit: &mut dyn FnMut(u32)) {
        for wrench in &self.0 {
            for value in wrench.impulse.to_array().into_iter().chain(wrench.angular_impulse.to_array()) {
                visit(value.to_bits() as u32);
                visit((value.to_bits() >> 32) as u32);
            }
        }
    }
    fn take_words(&mut self, _rows: usize, words: &[u32]) -> bool {
        let value = |pair: &[u32]| f64::from_bits(u64::from(pair[0]) | u64::from(pair[1]) << 32);
        let vector = |words: &[u32]| DVec3::new(value(words), value(&words[2..]), value(&words[4..]));
        let count = self.0.len();
        take_rows(&mut self.0, count, words, 12, |own, words| {
            *own = Wrench { impulse: vector(words), angular_impulse: vector(&words[6..]) };
        })
    }
    fn poison(&mut self) {
        self.0.fill(Wrench { impulse: DVec3::NAN, angular_impulse: DVec3::NAN });
    }
}
