//! Worlds on a GPU: what is placed there, and how their steps run.

mod device;
mod frame;
mod measure;
mod place;
mod request;

pub(crate) use device::Device;
pub(crate) use place::placed;
pub use request::StateRequest;
pub use sorb_kernels::gpu::{
    AdapterReport, Gpu, GpuError, adapters, required_features, required_limits, wgpu,
};
