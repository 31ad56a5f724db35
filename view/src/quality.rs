//! Which quality of pictures keeps up.

use std::time::Duration;

use sorb::render::View;

/// What a picture may take while something moves.
const BUDGET: Duration = Duration::from_millis(45);

/// Share of the budget below which a better quality is tried: the next one takes up to about four times as long.
const EASY: f32 = 0.22;

/// Pictures in a row that must be that quick.
const PATIENCE: u32 = 8;

/// Sides of the picture over those of the window, from the best quality to the quickest one.
const SCALES: [f32; 4] = [1.0, 1.0, 0.7, 0.5];

/// How a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// What is shown.
    pub view: View,
    /// Its sides over those of the window.
    pub scale: f32,
}

/// Chooses the quality of pictures by what the last ones took. It never changes what is simulated.
#[derive(Clone, Copy, Debug)]
pub struct QualityControl {
    level: usize,
    easy: u32,
}

impl Default for QualityControl {
    fn default() -> Self {
        Self { level: 1, easy: 0 }
    }
}

impl QualityControl {
    /// The quality of the next picture of a view: the best one where nothing moves.
    #[must_use]
    pub fn quality(&self, view: View, is_still: bool) -> Quality {
        if is_still || self.level == 0 {
            return Quality { view, scale: 1.0 };
        }
        let view = if view == View::Realistic { View::Fast } else { view };
        Quality { view, scale: SCALES[self.level] }
    }

    /// Takes note of what a picture took while something moved.
    pub fn took(&mut self, time: Duration) {
        if time > BUDGET {
            self.easy = 0;
            self.level = (self.level + 1).min(SCALES.len() - 1);
        } else if time.as_secs_f32() < EASY * BUDGET.as_secs_f32() {
            self.easy += 1;
            if self.easy >= PATIENCE {
                self.easy = 0;
                self.level = self.level.saturating_sub(1);
            }
        } else {
            self.easy = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_pictures_become_coarser_and_quick_ones_finer() {
        let mut control = QualityControl::default();
        assert_eq!(control.quality(View::Realistic, false), Quality { view: View::Fast, scale: 1.0 });
        for _ in 0..9 {
            control.took(Duration::from_millis(200));
        }
        assert_eq!(control.quality(View::Realistic, false), Quality { view: View::Fast, scale: 0.5 });
        // What is still, and other views, are shown as they are asked for.
        assert_eq!(control.quality(View::Realistic, true), Quality { view: View::Realistic, scale: 1.0 });
        assert_eq!(control.quality(View::Speed, false).view, View::Speed);
        for _ in 0..7 {
            control.took(Duration::from_millis(1));
        }
        // One picture that was quick by chance changes nothing.
        control.took(Duration::from_millis(30));
        assert_eq!(control.quality(View::Realistic, false).scale, 0.5);
        for _ in 0..100 {
            control.took(Duration::from_millis(1));
        }
        assert_eq!(control.quality(View::Realistic, false), Quality { view: View::Realistic, scale: 1.0 });
    }
}
