//! `sorb doctor`: features of this machine and this build.

use std::env::consts::{ARCH, OS};

use serde_json::json;
use sorb::SimdLevel;

use crate::{error::CliError, output};

/// Arguments of `sorb doctor`.
#[derive(Debug, clap::Args)]
pub(crate) struct Arguments {
    /// Prints a JSON object instead of text
    #[arg(long)]
    json: bool,
}

/// The features of the library that the command is built with.
const FEATURES: &[&str] = if cfg!(feature = "gpu") {
    &["threads", "rigid", "serde", "render", "gpu"]
} else {
    &["threads", "rigid", "serde", "render"]
};

/// Prints the features.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), CliError> {
    let names = |wanted: bool| {
        let levels = SimdLevel::ALL.into_iter().filter(|level| level.is_supported() == wanted);
        levels.map(SimdLevel::name).collect::<Vec<_>>()
    };
    let best = SimdLevel::best().name();
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let version = env!("CARGO_PKG_VERSION");
    let text = if arguments.json {
        let report = json!({
            "version": version,
            "platform": format!("{ARCH}-{OS}"),
            "threads": cores,
            "simd": { "auto": best, "supported": names(true), "missing": names(false) },
            "features": FEATURES,
            "gpu": gpu_json(),
        });
        format!("{}\n", serde_json::to_string_pretty(&report)?)
    } else {
        format!(
            "sorb      {version} on {ARCH}-{OS}\n\
             threads   {cores} by default (--threads 1 to 1024)\n\
             SIMD      {best} by default; supported: {}; missing: {}\n\
             features  {}\n\
             GPU       {}\n",
            names(true).join(", "),
            names(false).join(", "),
            FEATURES.join(", "),
            gpu_text()
        )
    };
    output::print(&text)
}

/// The adapters, best first.
#[cfg(feature = "gpu")]
fn gpu_json() -> serde_json::Value {
    let adapters = sorb::gpu::Gpu::adapters();
    let adapter = |adapter: &sorb::gpu::AdapterReport| {
        json!({
            "name": adapter.name,
            "driver": adapter.driver,
            "interface": adapter.backend,
            "kind": adapter.kind,
            "largest_binding_bytes": adapter.largest_binding,
            "times_kernels": adapter.timestamps,
            "auto": !adapter.is_software(),
        })
    };
    adapters.iter().map(adapter).collect()
}

#[cfg(not(feature = "gpu"))]
fn gpu_json() -> serde_json::Value {
    serde_json::Value::Null
}

#[cfg(feature = "gpu")]
fn gpu_text() -> String {
    let adapters = sorb::gpu::Gpu::adapters();
    if adapters.is_empty() {
        return "no adapter (on Linux, is a Vulkan driver and libvulkan1 installed?)".to_owned();
    }
    let line = |adapter: &sorb::gpu::AdapterReport| {
        let auto =
            if adapter.is_software() { "; `auto` does not take it: it is a program on the CPU" } else { "" };
        let sorb::gpu::AdapterReport { name, driver, backend, kind, largest_binding, timestamps, .. } =
            adapter;
        let times = if *timestamps { "times kernels" } else { "does not time kernels" };
        let mebibytes = largest_binding >> 20;
        format!("{name}, {kind}, {backend}, {driver}; buffers up to {mebibytes} MiB, {times}{auto}")
    };
    adapters.iter().map(line).collect::<Vec<_>>().join("\n          ")
}

#[cfg(not(feature = "gpu"))]
fn gpu_text() -> String {
    "not built in (feature `gpu`)".to_owned()
}
