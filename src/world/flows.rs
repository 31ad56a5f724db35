//! Emitters and drains, at the beginning of a step.

use glam::Vec3;

use super::{StepError, World};
use crate::{
    command::Region,
    handle::FlowHandle,
    scene::{Drain, Emitter, MAXIMUM_PARTICLES},
    water::{Flow, FlowKind, layer},
};

impl World {
    /// Handles and emitters of those that have not ended, in the order in which they began.
    pub fn emitters(&self) -> impl Iterator<Item = (FlowHandle, &Emitter)> {
        self.water.flows.iter().filter_map(|flow| match &flow.kind {
            FlowKind::Emitter(emitter) => Some((flow.number.into(), emitter)),
            FlowKind::Drain(_) => None,
        })
    }

    /// The same of drains. Emitters and drains are numbered together, those of the scene first.
    pub fn drains(&self) -> impl Iterator<Item = (FlowHandle, &Drain)> {
        self.water.flows.iter().filter_map(|flow| match &flow.kind {
            FlowKind::Drain(drain) => Some((flow.number.into(), drain)),
            FlowKind::Emitter(_) => None,
        })
    }

    /// The handle of the next emitter or drain that a command begins. No number is used twice.
    #[must_use]
    pub fn next_flow(&self) -> FlowHandle {
        self.water.next_flow.saturating_add(self.pending_flows()).into()
    }

    /// Begins an emitter or a drain.
    pub(super) fn begin_flow(&mut self, flow: FlowHandle, kind: FlowKind) {
        let number = flow.number();
        // Only a state that was made up has another one.
        if number == self.water.next_flow {
            self.water.next_flow = number.saturating_add(1);
            self.water.flows.push(Flow::new(number, kind, self.clock.time));
        }
    }

    /// Lets the water of emitters and drains come and go that is due.
    pub(super) fn flow(&mut self) -> Result<(), StepError> {
        let time = self.clock.time;
        let is_due = |flow: &Flow| match flow.kind {
            FlowKind::Emitter(_) => flow.due <= time,
            FlowKind::Drain(_) => flow.due < time,
        };
        // A device that cannot be read is lost, which the step reports.
        if !self.water.flows.iter().any(is_due) || !self.stores.move_to_host() {
            return Ok(());
        }
        let mut flows = std::mem::take(&mut self.water.flows);
        let mut result = Ok(());
        for flow in flows.iter_mut().filter(|flow| is_due(flow)) {
            result = result.and_then(|()| match flow.kind {
                FlowKind::Emitter(emitter) => self.emit(&emitter, &mut flow.due, time),
                FlowKind::Drain(drain) => {
                    let passed = time.min(f64::from(drain.end)) - flow.due;
                    flow.due = time;
                    self.drain(&drain, passed, &mut flow.spare)
                }
            });
        }
        flows.retain(|flow| flow.due < flow.end());
        self.water.flows = flows;
        result
    }

    /// Adds the layers of an emitter that have left it. Each is where it would be had it come in time.
    fn emit(&mut self, emitter: &Emitter, due: &mut f64, time: f64) -> Result<(), StepError> {
        let (spacing, gravity) = (self.params.fluid.spacing, self.params.gravity);
        let interval = f64::from(spacing / emitter.velocity.length());
        while *due <= time && *due < f64::from(emitter.end) {
            let layer = layer(emitter, spacing, gravity, (time - *due) as f32);
            *due += interval;
            let places = layer.iter().map(|(place, _)| *place);
            let room = self.room_for(places, around(emitter, spacing, gravity, time - *due));
            if self.stores.host.rows.fluid as u64 + room.points.len() as u64 > MAXIMUM_PARTICLES {
                self.water.left_out += room.points.len() as u64;
                continue;
            }
            self.add_water(&room, |place| layer[place].1)?;
        }
        Ok(())
    }

    /// Takes water out of a drain in some time \[s\]. What it could have taken is lost where there was too little.
    fn drain(&mut self, drain: &Drain, passed: f64, spare: &mut f64) -> Result<(), StepError> {
        let mass = f64::from(self.params.fluid.particle_mass);
        let allowed = f64::from(drain.rate) * passed.max(0.0) + *spare;
        let most = (allowed / mass).min(MAXIMUM_PARTICLES as f64).floor();
        let region = Region::Box { minimum: drain.minimum, maximum: drain.maximum };
        let taken = self.take_water(&region, most as usize)?;
        self.water.drained += taken as u64;
        *spare = if (taken as f64) < most { 0.0 } else { (allowed - taken as f64 * mass).min(mass) };
        Ok(())
    }
}

/// A box around a layer.
fn around(emitter: &Emitter, spacing: f32, gravity: Vec3, time: f64) -> (Vec3, Vec3) {
    let time = time.abs() as f32 + spacing / emitter.velocity.length();
    let reach = emitter.radius + spacing + (emitter.velocity.length() + gravity.length() * time) * time;
    (emitter.position - reach, emitter.position + reach)
}
