//! Worlds on a GPU: what is placed there, and how their steps run.

mod device;
mod frame;
mod place;

pub(crate) use device::Device;
pub(crate) use place::placed;
pub use sorb_kernels::gpu::{
    AdapterReport, Gpu, GpuError, adapters, required_features, required_limits, wgpu,
};
