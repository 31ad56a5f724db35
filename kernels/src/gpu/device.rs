//! Adapters and devices.

use std::{
    borrow::Cow,
    collections::BTreeMap,
    fmt,
    sync::{Arc, Mutex, PoisonError, atomic::AtomicU64},
};

use wgpu::{
    Adapter, AdapterInfo, Backends, CommandEncoder, Device, DeviceType, Features, Instance, Limits, Queue,
};

use super::{
    error::GpuError,
    groups::BUSY_THREADS,
    pipeline::{Pipeline, Threads},
};

/// What is known of an adapter of this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AdapterReport {
    /// Name, as the driver gives it.
    pub name: String,
    /// Driver and its version.
    pub driver: String,
    /// Interface: `vulkan`, `metal` or `dx12`.
    pub backend: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Largest buffer that a kernel can be bound to \[B\].
    pub largest_binding: u64,
    /// Whether kernels can be timed one by one.
    pub timestamps: bool,
}

impl AdapterReport {
    fn new(adapter: &Adapter) -> Self {
        let info = adapter.get_info();
        Self {
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            backend: info.backend.to_string(),
            kind: kind(&info),
            largest_binding: adapter.limits().max_storage_buffer_binding_size,
            timestamps: adapter.features().contains(TIMESTAMPS),
            name: info.name,
        }
    }

    /// Whether it is a program on the CPU (lavapipe, WARP), good for tests only.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.kind == "software"
    }
}

fn kind(info: &AdapterInfo) -> &'static str {
    match info.device_type {
        DeviceType::DiscreteGpu => "discrete",
        DeviceType::IntegratedGpu => "integrated",
        DeviceType::VirtualGpu => "virtual",
        DeviceType::Cpu => "software",
        DeviceType::Other => "other",
    }
}

/// Features for timing kernels; used if they are there.
const TIMESTAMPS: Features = Features::TIMESTAMP_QUERY.union(Features::TIMESTAMP_QUERY_INSIDE_PASSES);

/// The features that a host should request for a device that it provides; those the adapter has of the ones that sorb
/// can use. None is necessary.
#[must_use]
pub fn required_features(adapter: &Adapter) -> Features {
    adapter.features() & TIMESTAMPS.union(Features::SUBGROUP)
}

/// Most storage and uniform buffers of a dispatch that several passes are in, and bytes of a group.
const STORAGE_BUFFERS: u32 = 32;
const UNIFORM_BUFFERS: u32 = 4;
const GROUP_BYTES: u32 = 32_768;

/// The limits that a host should request for a device that it provides: WebGPU's defaults, with buffers as large as the
/// adapter allows, and what permits more passes in one dispatch.
#[must_use]
pub fn required_limits(adapter: &Adapter) -> Limits {
    let offered = adapter.limits();
    Limits {
        max_buffer_size: offered.max_buffer_size,
        max_storage_buffer_binding_size: offered.max_storage_buffer_binding_size,
        max_storage_buffers_per_shader_stage: offered
            .max_storage_buffers_per_shader_stage
            .min(STORAGE_BUFFERS),
        max_buffers_and_acceleration_structures_per_shader_stage: offered
            .max_buffers_and_acceleration_structures_per_shader_stage
            .min(STORAGE_BUFFERS + UNIFORM_BUFFERS),
        max_compute_workgroup_storage_size: offered.max_compute_workgroup_storage_size.min(GROUP_BYTES),
        ..Limits::default()
    }
}

/// Pipelines by shader, entry point and threads.
type Pipelines = BTreeMap<(Cow<'static, str>, &'static str, Threads), Arc<Pipeline>>;

/// A device to run kernels on, and the pipelines compiled for it so far. Worlds can share one.
pub struct Gpu {
    pub(super) device: Device,
    pub(super) queue: Queue,
    report: AdapterReport,
    pub(super) limits: Limits,
    /// Whether prefix sums use subgroup operations.
    pub(super) has_subgroups: bool,
    /// Threads that keep it busy.
    pub(super) busy_threads: u64,
    /// What the device reported outside any call.
    lost: Arc<Mutex<Option<String>>>,
    pub(super) pipelines: Mutex<Pipelines>,
    pub(super) bytes_read: AtomicU64,
}

impl fmt::Debug for Gpu {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_struct("Gpu").field("report", &self.report).finish_non_exhaustive()
    }
}

impl Gpu {
    /// Threads that keep a hardware adapter busy.
    pub const BUSY_THREADS: u64 = BUSY_THREADS;

    /// Every adapter of this machine, the one that [`Self::new`] takes first.
    #[must_use]
    pub fn adapters() -> Vec<AdapterReport> {
        adapters().iter().map(AdapterReport::new).collect()
    }

    /// The best adapter of this machine: discrete before integrated, a real one before a software one.
    ///
    /// # Errors
    /// There is no adapter, or it gives no device.
    pub fn new() -> Result<Self, GpuError> {
        let adapter = adapters().into_iter().next().ok_or(GpuError::NoAdapter)?;
        Self::on_adapter(&adapter)
    }

    /// A device of its own on an adapter that the host has chosen.
    ///
    /// # Errors
    /// The adapter gives no device.
    pub fn on_adapter(adapter: &Adapter) -> Result<Self, GpuError> {
        Self::with_limits(adapter, required_limits(adapter))
    }

    /// [`Self::on_adapter`] with other limits than [`required_limits`], such as lower ones for a test.
    ///
    /// # Errors
    /// The adapter gives no device with these limits.
    pub fn with_limits(adapter: &Adapter, limits: Limits) -> Result<Self, GpuError> {
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("sorb"),
            required_features: required_features(adapter),
            required_limits: limits,
            memory_hints: wgpu::MemoryHints::Performance,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(|error| {
            GpuError::NoDevice { adapter: adapter.get_info().name, reason: error.to_string() }
        })?;
        Ok(Self::with_device(adapter, device, queue))
    }

    /// A device of the host, made with [`required_features`] and [`required_limits`]. The host keeps its handlers of
    /// uncaptured errors; its callback for the loss of the device is replaced.
    #[must_use]
    pub fn with_device(adapter: &Adapter, device: Device, queue: Queue) -> Self {
        let lost = Arc::new(Mutex::new(None));
        let note = Arc::clone(&lost);
        device.set_device_lost_callback(move |reason, message| {
            let text = format!("{reason:?}: {message}");
            note.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(text);
        });
        let report = AdapterReport::new(adapter);
        Self {
            busy_threads: if report.is_software() { 0 } else { BUSY_THREADS },
            report,
            limits: device.limits(),
            has_subgroups: false,
            device,
            queue,
            lost,
            pipelines: Mutex::default(),
            bytes_read: AtomicU64::new(0),
        }
    }

    /// Whether prefix sums use subgroup operations.
    #[must_use]
    pub fn has_subgroups(&self) -> bool {
        self.has_subgroups
    }

    /// The same device with another number of threads that keep it busy. Up to 16 threads share a row of a pass over few rows, until it
    /// has so many threads; with 0 every row has one. The default is [`Self::BUSY_THREADS`], and 0 for an adapter in software, where a sum
    /// over threads takes longer than one thread that adds up. With another number, sums have another order and other last digits.
    #[must_use]
    pub fn with_busy_threads(mut self, threads: u64) -> Self {
        self.busy_threads = threads;
        self
    }

    /// Threads that keep the device busy.
    #[must_use]
    pub fn busy_threads(&self) -> u64 {
        self.busy_threads
    }

    /// What the adapter is.
    #[must_use]
    pub fn report(&self) -> &AdapterReport {
        &self.report
    }

    /// The device, for a host that draws from the same buffers.
    #[must_use]
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// The queue of the device.
    #[must_use]
    pub fn queue(&self) -> &Queue {
        &self.queue
    }

    /// Whether kernels can be timed one by one.
    #[must_use]
    pub fn has_timestamps(&self) -> bool {
        self.device.features().contains(TIMESTAMPS)
    }

    /// Runs `work`, and turns what the device reports meanwhile into an error; `buffer` is what it makes, and its size.
    ///
    /// # Errors
    /// The device reports one, or it is lost.
    pub fn guarded<R>(
        &self,
        buffer: Option<(&'static str, u64)>,
        work: impl FnOnce() -> R,
    ) -> Result<R, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let result = work();
        // Scopes are closed in reverse order.
        let validation = pollster::block_on(validation.pop());
        let internal = pollster::block_on(internal.pop());
        let memory = pollster::block_on(memory.pop());
        self.check_lost()?;
        if let Some(error) = memory {
            let (buffer, needed) = buffer.unwrap_or(("a submission", 0));
            return Err(GpuError::OutOfMemory { buffer, needed, reason: error.to_string() });
        }
        match validation.or(internal) {
            Some(error) => Err(GpuError::Refused { reason: error.to_string() }),
            None => Ok(result),
        }
    }

    pub(super) fn encoder(&self) -> CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("sorb") })
    }

    /// The loss of the device, if it was lost.
    pub(super) fn check_lost(&self) -> Result<(), GpuError> {
        match self.lost.lock().unwrap_or_else(PoisonError::into_inner).clone() {
            Some(reason) => Err(GpuError::Lost { reason }),
            None => Ok(()),
        }
    }
}

/// Every adapter of this machine, best first, for a host or a test that chooses itself.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = Backends::PRIMARY;
    let instance = Instance::new(descriptor);
    let mut adapters = pollster::block_on(instance.enumerate_adapters(Backends::PRIMARY));
    let rank = |adapter: &Adapter| match adapter.get_info().device_type {
        DeviceType::DiscreteGpu => 0,
        DeviceType::IntegratedGpu => 1,
        DeviceType::VirtualGpu => 2,
        DeviceType::Other => 3,
        DeviceType::Cpu => 4,
    };
    adapters.sort_by_key(rank);
    adapters
}
