//! Threads, SIMD level and backend of a world.

use std::{ffi::c_char, ptr};

use sorb::SimdLevel;

use crate::{
    failure::{Fails, Failure, Status},
    memory::{read_sized, text, versioned},
};

/// What a world runs on. Zeros are the defaults. Threads and SIMD level have no effect on results.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Options {
    /// `sizeof(sorb_options)`.
    pub size: usize,
    /// Number of threads, 1 to 1024; 0: one per core.
    pub threads: u32,
    /// SIMD level: "fallback", "sse4.2", "avx2", "avx512" or "neon"; NULL: the best of the machine.
    pub simd: *const c_char,
    /// Where it runs: "cpu", "gpu", "auto" or another text that `sorb run --backend` takes; NULL: "cpu". "gpu" needs a library that was
    /// built with the feature `gpu`.
    pub backend: *const c_char,
}

versioned! { Options "sorb_options", }

/// Reads options; null ones are the defaults.
///
/// # Safety
/// They are null, or as large as they say, with texts that end with a zero.
pub(crate) unsafe fn read(options: *const Options) -> Result<sorb::Options, Failure> {
    let default = Options { size: 0, threads: 0, simd: ptr::null(), backend: ptr::null() };
    let mut read = sorb::Options::default();
    if options.is_null() {
        return Ok(read);
    }
    // SAFETY: the promise of the caller.
    let own = unsafe { read_sized(options, default) }?;
    read.threads = (own.threads > 0).then_some(own.threads as usize);
    if !own.simd.is_null() {
        // SAFETY: the promise of the caller.
        read.simd = Some(simd(unsafe { text(own.simd, "options.simd") }?)?);
    }
    if !own.backend.is_null() {
        // SAFETY: the promise of the caller.
        read.offload = unsafe { text(own.backend, "options.backend") }?.parse().fails(Status::World)?;
    }
    Ok(read)
}

fn simd(name: &str) -> Result<SimdLevel, Failure> {
    let known = || SimdLevel::ALL.map(SimdLevel::name).join(", ");
    SimdLevel::from_name(name).ok_or_else(|| {
        Failure::new(Status::World, format!("options.simd = \"{name}\" is no level; levels: {}", known()))
    })
}
