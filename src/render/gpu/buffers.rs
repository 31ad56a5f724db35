//! Buffers of the renderer by name; they grow with what is drawn and are kept.

use std::{
    collections::{BTreeMap, BTreeSet},
    sync::Arc,
};

use sorb_kernels::gpu::{
    Gpu, GpuError,
    wgpu::{Buffer, BufferDescriptor, BufferUsages},
};

/// Bytes of the smallest buffer: nothing can be bound to an empty one, and a row of a body is bound whole.
const LEAST: u64 = 256;

/// Buffers by the names that shaders have for them.
#[derive(Debug)]
pub(super) struct Buffers {
    gpu: Arc<Gpu>,
    all: BTreeMap<&'static str, Buffer>,
    /// Names of buffers of somebody else.
    lent: BTreeSet<&'static str>,
}

impl Buffers {
    pub(super) fn new(gpu: &Arc<Gpu>) -> Self {
        Self { gpu: Arc::clone(gpu), all: BTreeMap::new(), lent: BTreeSet::new() }
    }

    /// Makes room for some bytes. A new buffer is zeroed; one that was large enough keeps its content.
    pub(super) fn reserve(&mut self, name: &'static str, bytes: u64) -> Result<(), GpuError> {
        if self.all.get(name).is_some_and(|buffer| buffer.size() >= bytes.max(LEAST)) {
            return Ok(());
        }
        let limits = self.gpu.device().limits();
        let limit = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        if bytes > limit {
            let reason = format!("the adapter binds at most {limit} bytes");
            return Err(GpuError::OutOfMemory { buffer: name, needed: bytes, reason });
        }
        // A little more than is needed now, so that it need not grow again with the next picture.
        let size =
            (bytes + bytes / 4).clamp(LEAST, limit.max(LEAST)).next_multiple_of(16).min(limit / 16 * 16);
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC | BufferUsages::COPY_DST;
        let descriptor = BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
        let made = self.gpu.guarded(Some((name, size)), || self.gpu.device().create_buffer(&descriptor))?;
        self.all.insert(name, made);
        Ok(())
    }

    /// A uniform buffer with some words.
    pub(super) fn write_uniform(&mut self, name: &'static str, words: &[u32]) -> Result<(), GpuError> {
        let size = 4 * words.len() as u64;
        if self.all.get(name).is_none_or(|buffer| buffer.size() < size) {
            let usage = BufferUsages::UNIFORM | BufferUsages::COPY_DST;
            let descriptor = BufferDescriptor { label: Some(name), size, usage, mapped_at_creation: false };
            let made =
                self.gpu.guarded(Some((name, size)), || self.gpu.device().create_buffer(&descriptor))?;
            self.all.insert(name, made);
        }
        self.write_words(name, bytemuck::cast_slice(words));
        Ok(())
    }

    /// Stores data in a buffer that is large enough for it.
    pub(super) fn write(&mut self, name: &'static str, bytes: &[u8]) -> Result<(), GpuError> {
        self.reserve(name, bytes.len() as u64)?;
        self.write_words(name, bytes);
        Ok(())
    }

    fn write_words(&self, name: &'static str, bytes: &[u8]) {
        if let Some(buffer) = self.all.get(name).filter(|_| !bytes.is_empty()) {
            self.gpu.queue().write_buffer(buffer, 0, bytes);
        }
    }

    /// Takes a buffer of somebody else under a name.
    pub(super) fn lend(&mut self, name: &'static str, buffer: &Buffer) {
        self.all.insert(name, buffer.clone());
        self.lent.insert(name);
    }

    /// Gives a buffer of somebody else back, if one is under a name.
    pub(super) fn restore(&mut self, name: &'static str) {
        if self.lent.remove(name) {
            self.all.remove(name);
        }
    }

    /// A buffer of a name.
    pub(super) fn get(&self, name: &'static str) -> Result<&Buffer, GpuError> {
        self.all.get(name).ok_or_else(|| GpuError::Refused { reason: format!("there is no buffer {name}") })
    }
}
