//! Steps on the device: one submission for many, and one small answer.

use wgpu::CommandBuffer;

use super::{
    answer::{Answer, CLOCK_BYTES, Clock, Extreme, Outcome, Start, WRENCH_BYTES},
    error::GpuError,
    layout::Value,
    profile::Profile,
    program::{Dispatch, Program},
    resident::Resident,
};
use crate::{columns::Column, kernel::Kernel};

/// Steps of one submission.
const STEPS_AT_ONCE: u32 = 16;

/// What did not fit.
const LENGTHS: [Extreme; 7] = [
    Extreme::Neighbors,
    Extreme::Controls,
    Extreme::ControlFluid,
    Extreme::Pairs,
    Extreme::NearImages,
    Extreme::ImageParticles,
    Extreme::Images,
];

/// Where steps begin.
#[derive(Clone, Copy, Debug)]
enum From {
    /// With the clock.
    Begin,
    /// With more rounds of a repetition, counted from 1, that the device stopped at.
    Rounds(usize, u32),
}

impl Resident {
    /// Sets the time that the next steps are to fill.
    pub fn set_time(&mut self, start: &Start) {
        self.steps = 0;
        self.has_begun = false;
        self.write("clock", bytemuck::cast_slice(&Clock::before(start).words()));
    }

    /// Sets one step of this length, for kernels that run without the others.
    fn set_step(&self, step: f32) {
        self.write("clock", bytemuck::cast_slice(&Clock::of_step(step).words()));
    }

    /// Forgets the extremes that kernels are about to find, and keeps those that were found before them.
    fn clear_extremes(&self, program: &Program) {
        let mut stale = LENGTHS.to_vec();
        if program.runs(|kernel| kernel.renews(Column::FluidExtremes)) {
            stale.extend([Extreme::FluidSpeed, Extreme::FluidAcceleration, Extreme::FluidRow]);
        }
        if program.runs(|kernel| kernel.renews(Column::NodeExtremes)) {
            stale.extend([Extreme::NodeSpeed, Extreme::NodeRow]);
        }
        stale.into_iter().for_each(|extreme| self.write_extreme(extreme, 0));
    }

    pub(super) fn write_extreme(&self, extreme: Extreme, word: u32) {
        self.gpu.queue.write_buffer(self.buffer("extremes"), 4 * extreme as u64, &word.to_ne_bytes());
    }

    /// Runs kernels once, with a step of the given length; lists that do not fit are made longer. For a step that is
    /// shared with the CPU, and for tests.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn run_kernels(&mut self, program: &mut Program, step: f32) -> Result<(), GpuError> {
        loop {
            self.keep_bound(program)?;
            self.set_step(step);
            self.clear_extremes(program);
            self.submit(&program.passes_from(0, 0), true, None)?;
            let mut answer = self.read_answer()?;
            while let Some((index, done)) = answer.unfinished {
                let added = program.added_rounds(index, done);
                let mut passes = vec![&program.resume[..]];
                passes.extend(program.passes_from(index, added));
                self.submit(&passes, true, None)?;
                answer = self.read_answer()?;
            }
            program.expect(answer.maximum_rounds);
            let Some(longest) = answer.longest else { break };
            self.lengthen(longest)?;
        }
        if program.runs(Kernel::sorts_fluid) {
            self.sorted = true;
        }
        if program.runs(Kernel::returns_fluid) {
            self.sorted = false;
        }
        Ok(())
    }

    /// Takes up to `steps` steps (1 or added) of the time that was set; fewer if that is filled, or something went wrong.
    ///
    /// # Errors
    /// The device was lost, or lists that have to be longer do not fit its memory. No state of a half-finished step is
    /// left behind.
    pub fn advance(
        &mut self,
        program: &mut Program,
        steps: u32,
        mut profile: Option<&mut Profile>,
    ) -> Result<Answer, GpuError> {
        let mut to_do = steps;
        let mut from = From::Begin;
        loop {
            self.keep_bound(program)?;
            match from {
                From::Begin if to_do == 1 && profile.is_none() => self.submit_step(program)?,
                _ => self.submit_steps(program, from, to_do, profile.as_deref_mut())?,
            }
            let answer = self.read_answer()?;
            to_do -= to_do.min(answer.steps - self.steps);
            self.steps = answer.steps;
            program.expect(answer.maximum_rounds);
            if let Some(longest) = answer.longest {
                self.lengthen(longest)?;
                self.has_begun = false;
                from = From::Begin;
            } else if let Some((index, done)) = answer.unfinished {
                from = From::Rounds(index, program.added_rounds(index, done));
            } else {
                // The last step has begun the next one.
                self.has_begun = answer.outcome == Outcome::Done;
                return Ok(answer);
            }
        }
    }

    /// Submits one step, and encodes the next while the device works: with bodies, every step waits for the host.
    fn submit_step(&mut self, program: &mut Program) -> Result<(), GpuError> {
        let buffer = match program.prepared.take().filter(|_| self.has_begun) {
            Some(buffer) => buffer,
            None => self.encode_step(program)?,
        };
        self.submit_buffer(buffer)?;
        self.has_begun = true;
        program.prepared = Some(self.encode_step(program)?);
        Ok(())
    }

    fn encode_step(&self, program: &Program) -> Result<CommandBuffer, GpuError> {
        let mut passes = Vec::new();
        if !self.has_begun {
            passes.push(&program.begin[..]);
        }
        passes.extend(program.passes_from(0, 0));
        passes.push(&program.finish);
        self.gpu.guarded(None, || self.encode(&passes, true, None))
    }

    /// Submits steps, a few at a time: the device works on some while the host encodes the next.
    fn submit_steps(
        &self,
        program: &Program,
        from: From,
        steps: u32,
        mut profile: Option<&mut Profile>,
    ) -> Result<(), GpuError> {
        let at_once = if profile.is_some() { steps } else { STEPS_AT_ONCE };
        let (mut passes, mut index, added): (Vec<&[Dispatch]>, _, _) = match from {
            From::Begin => (vec![&program.begin], 0, 0),
            From::Rounds(index, added) => (vec![&program.resume], index, added),
        };
        for step in 1..=steps {
            passes.extend(program.passes_from(index, added));
            passes.push(&program.finish);
            index = 0;
            if step % at_once == 0 || step == steps {
                self.submit(&passes, step == steps, profile.as_deref_mut())?;
                passes.clear();
            }
        }
        Ok(())
    }

    /// Encodes and submits passes, all in one, and the copy of what [`Self::read_answer`] waits for.
    pub(super) fn submit(
        &self,
        passes: &[&[Dispatch]],
        answers: bool,
        mut profile: Option<&mut Profile>,
    ) -> Result<(), GpuError> {
        let buffer = self.gpu.guarded(None, || self.encode(passes, answers, profile.as_deref_mut()))?;
        self.submit_buffer(buffer)?;
        match profile {
            Some(profile) => profile.collect(&self.gpu),
            None => Ok(()),
        }
    }

    fn submit_buffer(&self, buffer: CommandBuffer) -> Result<(), GpuError> {
        self.gpu.guarded(None, || {
            self.gpu.queue.submit([buffer]);
        })
    }

    fn encode(
        &self,
        passes: &[&[Dispatch]],
        answers: bool,
        mut profile: Option<&mut Profile>,
    ) -> CommandBuffer {
        let mut encoder = self.gpu.encoder();
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            if let Some(profile) = profile.as_deref_mut() {
                profile.start(&mut pass);
            }
            let mut dispatches = passes.iter().copied().flatten().peekable();
            while let Some(dispatch) = dispatches.next() {
                pass.set_pipeline(&dispatch.pipeline.pipeline);
                pass.set_bind_group(0, &dispatch.bind, &[]);
                let [x, y, z] = dispatch.groups;
                pass.dispatch_workgroups(x, y, z);
                let ends = dispatches.peek().is_none_or(|next| next.kernel != dispatch.kernel);
                if let Some(profile) = profile.as_deref_mut().filter(|_| ends) {
                    profile.mark(&mut pass, dispatch.kernel);
                }
            }
        }
        if let Some(profile) = profile {
            profile.resolve(&mut encoder);
        }
        if answers {
            let (clock, wrenches) = (self.buffer("clock"), self.buffer("body_wrenches"));
            encoder.copy_buffer_to_buffer(clock, 0, &self.answer, 0, CLOCK_BYTES);
            let size = self.rows.bodies as u64 * WRENCH_BYTES;
            encoder.copy_buffer_to_buffer(wrenches, 0, &self.answer, CLOCK_BYTES, size);
        }
        encoder.finish()
    }

    /// Waits for the clock and the wrenches after a batch, a few hundred bytes.
    pub(super) fn read_answer(&self) -> Result<Answer, GpuError> {
        let bytes = self.gpu.map(&self.answer)?;
        self.answer.unmap();
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        let (clock, wrenches) = words.split_at(Clock::WORDS);
        Ok(Answer::new(&Clock::take(clock), bytemuck::cast_slice(wrenches)))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        gpu::Gpu,
        grid,
        tests::{
            gpu::LIMITS,
            scene::{FULL, Scene},
        },
    };

    #[test]
    fn lengths_of_lists_in_an_earlier_step_are_forgotten() {
        let scene = Scene::new(FULL);
        let fail = |error: GpuError| -> ! { panic!("{error}") };
        let gpu = Arc::new(Gpu::new().unwrap_or_else(|error| fail(error)));
        let mut columns = scene.columns.clone();
        let mut resident =
            Resident::new(&gpu, &columns, &scene.params, LIMITS).unwrap_or_else(|error| fail(error));
        let search = [&grid::sort_fluid::KERNEL, &grid::fluid_neighbors::KERNEL];
        let reads: Vec<Column> = search.iter().flat_map(|kernel| kernel.reads).copied().collect();
        resident.upload(&mut columns, &reads, false).unwrap_or_else(|error| fail(error));
        let mut program = resident.program(&search).unwrap_or_else(|error| fail(error));
        let before = resident.capacities;
        for extreme in LENGTHS {
            resident.write_extreme(extreme, 1 << 12);
            resident.run_kernels(&mut program, 1e-4).unwrap_or_else(|error| fail(error));
            assert_eq!(resident.capacities, before, "{extreme:?}");
        }
        // Negative control: without clearing, the step stops for a list that is too long.
        resident.write_extreme(Extreme::Neighbors, 1 << 12);
        resident.set_step(1e-4);
        resident.submit(&program.passes_from(0, 0), true, None).unwrap_or_else(|error| fail(error));
        let answer = resident.read_answer().unwrap_or_else(|error| fail(error));
        assert!(answer.longest.is_some());
    }
}
