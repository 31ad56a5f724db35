//! What the steps of a frame were.

use crate::{
    clock::Bound,
    world::{FrameReport, StepReport},
};

/// Counts the steps of a frame.
#[derive(Debug)]
pub(crate) struct FrameTally {
    report: FrameReport,
    /// Steps of every bound, in the order in which bounds came.
    bounds: Vec<(Bound, u32)>,
}

impl FrameTally {
    /// A frame without steps; `bound` is the bound of one that has none.
    pub(crate) fn new(bound: Bound) -> Self {
        let report =
            FrameReport { time: 0.0, steps: 0, shortest_step: f32::INFINITY, bound, maximum_speed: 0.0 };
        Self { report, bounds: Vec::new() }
    }

    /// Adds a step. Sleep is no step, but counts among the bounds.
    pub(crate) fn add(&mut self, step: &StepReport) {
        let is_step = step.bound != Bound::Asleep;
        let shortest = if is_step { step.step } else { f32::INFINITY };
        self.add_steps(u32::from(is_step), shortest, step.maximum_speed);
        self.add_bounds(step.bound, 1);
    }

    /// Adds steps, the shortest of which has this length \[s\], with the largest speed in them \[m/s\].
    pub(crate) fn add_steps(&mut self, steps: u32, shortest: f32, maximum_speed: f32) {
        let report = &mut self.report;
        report.steps += steps;
        report.shortest_step = report.shortest_step.min(shortest);
        report.maximum_speed = report.maximum_speed.max(maximum_speed);
    }

    /// Adds steps that a bound limited.
    pub(crate) fn add_bounds(&mut self, bound: Bound, steps: u32) {
        match self.bounds.iter_mut().find(|(own, _)| *own == bound) {
            Some((_, count)) => *count += steps,
            None if steps > 0 => self.bounds.push((bound, steps)),
            None => {}
        }
    }

    /// The report of the frame, which ends at this time \[s\]. Of bounds with as many steps, the first one counts.
    pub(crate) fn finish(self, time: f64) -> FrameReport {
        let most = self.bounds.iter().rev().max_by_key(|(_, count)| *count);
        FrameReport { time, bound: most.map_or(self.report.bound, |most| most.0), ..self.report }
    }
}
