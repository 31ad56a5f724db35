//! Steps on the device: one submission for many, and one small answer.

use std::sync::Arc;

use wgpu::{BindGroup, CommandBuffer, CommandEncoder};

use super::{
    answer::{Answer, CLOCK_BYTES, Start, WRENCH_BYTES},
    error::GpuError,
    pack::{BATCH_STRIDE, BATCHES, Capacities},
    pipeline::Pipeline,
    profile::Profile,
    resident::Resident,
    twins::{BEGIN, BODY_WRENCHES, FINISH, Pass, Rows, twin},
};
use crate::{kernel::Kernel, pbd::lattice::COLORS};

/// Steps of one submission.
const STEPS_AT_ONCE: u32 = 16;

/// A pass bound to its buffers.
#[derive(Debug)]
struct Dispatch {
    kernel: &'static str,
    pipeline: Arc<Pipeline>,
    bind: BindGroup,
    groups: [u32; 2],
}

/// The passes of a step in order, bound to the buffers of a [`Resident`].
#[derive(Debug)]
pub struct Program {
    kernels: Vec<&'static Kernel>,
    begin: Vec<Dispatch>,
    step: Vec<Dispatch>,
    finish: Vec<Dispatch>,
    /// A step that is encoded and waits for its turn.
    prepared: Option<CommandBuffer>,
}

impl Program {
    /// Passes of a step.
    #[must_use]
    pub fn passes(&self) -> usize {
        self.step.len() + self.finish.len()
    }
}

impl Resident {
    /// Binds kernels, in the order in which they are to run.
    ///
    /// # Errors
    /// A kernel has no twin, or a pipeline cannot be compiled.
    pub fn program(&self, kernels: &[&'static Kernel]) -> Result<Program, GpuError> {
        let mut step = Vec::new();
        let mut before = "";
        for kernel in kernels {
            let passes = twin(kernel.name).ok_or(GpuError::NoTwin { kernel: kernel.name })?;
            // The search has every pair at hand and sums up the density.
            let is_done = kernel.name == "sph::density" && before == "grid::fluid_neighbors";
            for pass in passes.iter().filter(|_| !is_done) {
                self.bind(kernel.name, pass, &mut step)?;
            }
            before = kernel.name;
        }
        let (mut begin, mut finish) = (Vec::new(), Vec::new());
        self.bind("clock", &BEGIN, &mut begin)?;
        if self.rows.bodies > 0 {
            self.bind("clock", &BODY_WRENCHES, &mut finish)?;
        }
        self.bind("clock", &FINISH, &mut finish)?;
        Ok(Program { kernels: kernels.to_vec(), begin, step, finish, prepared: None })
    }

    fn bind(&self, kernel: &'static str, pass: &Pass, into: &mut Vec<Dispatch>) -> Result<(), GpuError> {
        let pipeline = self.gpu.pipeline(pass.shader, pass.entry)?;
        let batches = match pass.rows {
            Rows::Colors => 0..COLORS,
            Rows::VertexColors => COLORS..BATCHES,
            _ => 0..1,
        };
        for color in batches {
            let groups = self.groups(pass.rows, color);
            if groups[0] > 0 {
                let bind = self.gpu.guarded(None, || self.bind_group(pass, &pipeline, color))?;
                into.push(Dispatch { kernel, pipeline: Arc::clone(&pipeline), bind, groups });
            }
        }
        Ok(())
    }

    fn bind_group(&self, pass: &Pass, pipeline: &Pipeline, color: usize) -> BindGroup {
        let entries: Vec<_> = pipeline
            .bindings
            .iter()
            .map(|binding| {
                let name = pass.buffer(binding.name);
                let buffer = self.buffer(name);
                let mut part = buffer.as_entire_buffer_binding();
                if name == "batch" {
                    part.offset = color as u64 * BATCH_STRIDE;
                    part.size = std::num::NonZeroU64::new(16);
                }
                wgpu::BindGroupEntry { binding: binding.index, resource: wgpu::BindingResource::Buffer(part) }
            })
            .collect();
        self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(pass.shader),
            layout: &pipeline.layout,
            entries: &entries,
        })
    }

    /// Groups of a pass in two dimensions, none larger than the device allows.
    fn groups(&self, rows: Rows, color: usize) -> [u32; 2] {
        let threads = |rows: usize| rows.div_ceil(256) as u64;
        let count = match rows {
            Rows::One => 1,
            Rows::Fluid => threads(self.rows.fluid),
            Rows::Nodes => threads(self.rows.nodes),
            Rows::Controls => self.rows.nodes.div_ceil(8) as u64,
            Rows::FluidOrNodes => threads(self.rows.fluid.max(self.rows.nodes)),
            Rows::FluidPages => self.grids[0].pages(),
            Rows::ControlPages => self.grids[1].pages(),
            Rows::Bodies => self.rows.bodies as u64,
            Rows::Colors | Rows::VertexColors => threads(self.batches[color][1] as usize),
            Rows::Sponges => self.params.sponges.len() as u64,
        };
        let most = u64::from(self.gpu.limits.max_compute_workgroups_per_dimension);
        if count <= most {
            return [count as u32, 1];
        }
        let lines = count.div_ceil(most);
        [count.div_ceil(lines) as u32, lines as u32]
    }

    /// Sets the time that the next steps are to fill.
    pub fn set_time(&mut self, start: &Start) {
        self.steps = 0;
        let mut words = [0_u32; 32];
        words[4] = start.left.to_bits();
        words[5] = start.fluid_speed.to_bits();
        words[6] = start.fluid_acceleration.to_bits();
        words[7] = start.node_speed.to_bits();
        words[10] = f32::MAX.to_bits();
        self.write("clock", bytemuck::cast_slice(&words));
    }

    /// Sets one step of this length, for kernels that run without the others.
    fn set_step(&self, step: f32) {
        let mut words = [0_u32; 32];
        words[0] = step.to_bits();
        words[1] = (1.0 / step).to_bits();
        words[2] = 1;
        words[4] = step.to_bits();
        words[19] = 1;
        self.write("clock", bytemuck::cast_slice(&words));
    }

    /// Forgets the extremes that kernels are about to find, and keeps those that were found before them.
    fn clear_extremes(&self, kernels: &[&'static Kernel]) {
        let runs = |name: &str| kernels.iter().any(|kernel| kernel.name == name);
        let mut stale = vec![5, 6, 7];
        if runs("sph::kick") {
            stale.extend([0, 1, 3]);
        }
        if runs("pbd::velocity") {
            stale.extend([2, 4]);
        }
        for word in stale {
            self.gpu.queue.write_buffer(self.buffer("extremes"), word * 4, &[0; 4]);
        }
    }

    /// Runs kernels once, with a step of the given length; lists that do not fit are made longer. For a step that is
    /// shared with the CPU, and for tests.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn run_kernels(&mut self, program: &mut Program, step: f32) -> Result<(), GpuError> {
        loop {
            self.set_step(step);
            self.clear_extremes(&program.kernels);
            self.submit(&[&program.step], true, None)?;
            let Some(longest) = self.listen()?.longest else { break };
            self.grow(longest, program)?;
        }
        for kernel in &program.kernels {
            match kernel.name {
                "grid::sort_fluid" => self.sorted = true,
                "sph::advect" => self.sorted = false,
                _ => {}
            }
        }
        Ok(())
    }

    /// Takes up to `steps` steps (1 or more) of the time that was set; fewer if that is filled, or something went wrong.
    ///
    /// # Errors
    /// The device was lost, or lists that have to be longer do not fit its memory: no state of a half-finished step is
    /// left behind.
    pub fn advance(
        &mut self,
        program: &mut Program,
        steps: u32,
        mut profile: Option<&mut Profile>,
    ) -> Result<Answer, GpuError> {
        let mut to_do = steps;
        loop {
            if to_do == 1 && profile.is_none() {
                self.submit_step(program)?;
            } else {
                self.submit_steps(program, to_do, profile.as_deref_mut())?;
            }
            let answer = self.listen()?;
            to_do -= to_do.min(answer.steps - self.steps);
            self.steps = answer.steps;
            let Some(longest) = answer.longest else {
                return Ok(answer);
            };
            self.grow(longest, program)?;
        }
    }

    /// Submits one step, and encodes the next while the device works: with bodies, every step waits for the host.
    fn submit_step(&mut self, program: &mut Program) -> Result<(), GpuError> {
        let buffer = match program.prepared.take() {
            Some(buffer) => buffer,
            None => self.encode_step(program)?,
        };
        self.hand_in(buffer)?;
        program.prepared = Some(self.encode_step(program)?);
        Ok(())
    }

    fn encode_step(&self, program: &Program) -> Result<CommandBuffer, GpuError> {
        let parts = [&program.begin[..], &program.step, &program.finish];
        self.gpu.guarded(None, || self.encode(&parts, true, None))
    }

    /// Submits steps, a few at a time: the device works on some while the host encodes the next.
    fn submit_steps(
        &self,
        program: &Program,
        steps: u32,
        mut profile: Option<&mut Profile>,
    ) -> Result<(), GpuError> {
        let at_once = if profile.is_some() { steps } else { STEPS_AT_ONCE };
        let mut parts: Vec<&[Dispatch]> = vec![&program.begin];
        for step in 1..=steps {
            parts.extend([&program.step[..], &program.finish[..]]);
            if step % at_once == 0 || step == steps {
                self.submit(&parts, step == steps, profile.as_deref_mut())?;
                parts.clear();
            }
        }
        Ok(())
    }

    fn grow(&mut self, longest: Capacities, program: &mut Program) -> Result<(), GpuError> {
        self.lengthen(longest)?;
        // The bind groups hold the old buffers.
        *program = self.program(&program.kernels)?;
        Ok(())
    }
}

impl Resident {
    /// Encodes and submits passes, all in one, and the copy of what [`Self::listen`] waits for.
    fn submit(
        &self,
        parts: &[&[Dispatch]],
        answers: bool,
        mut profile: Option<&mut Profile>,
    ) -> Result<(), GpuError> {
        let buffer = self.gpu.guarded(None, || self.encode(parts, answers, profile.as_deref_mut()))?;
        self.hand_in(buffer)?;
        match profile {
            Some(profile) => profile.collect(&self.gpu),
            None => Ok(()),
        }
    }

    fn hand_in(&self, buffer: CommandBuffer) -> Result<(), GpuError> {
        self.gpu.guarded(None, || {
            self.gpu.queue.submit([buffer]);
        })
    }

    fn encode(
        &self,
        parts: &[&[Dispatch]],
        answers: bool,
        mut profile: Option<&mut Profile>,
    ) -> CommandBuffer {
        let mut encoder = self.encoder();
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            if let Some(profile) = profile.as_deref_mut() {
                profile.start(&mut pass);
            }
            let mut dispatches = parts.iter().copied().flatten().peekable();
            while let Some(dispatch) = dispatches.next() {
                pass.set_pipeline(&dispatch.pipeline.pipeline);
                pass.set_bind_group(0, &dispatch.bind, &[]);
                pass.dispatch_workgroups(dispatch.groups[0], dispatch.groups[1], 1);
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

    pub(super) fn encoder(&self) -> CommandEncoder {
        self.gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("sorb") })
    }

    /// What the device has to say: a few hundred bytes.
    fn listen(&self) -> Result<Answer, GpuError> {
        let bytes = self.gpu.map(&self.answer)?;
        self.answer.unmap();
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        let (clock, wrenches) = words.split_at(CLOCK_BYTES as usize / 4);
        Ok(Answer::new(clock, bytemuck::cast_slice(wrenches)))
    }
}
