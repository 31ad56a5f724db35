//! Worlds on a GPU: placement of kernels, and how their steps run.

mod device;
mod frame;
mod measure;
mod place;
mod query;
mod request;
mod shares;

pub(crate) use device::Device;
pub use request::{State, StateRequest};
pub use sorb_kernels::gpu::{
    AdapterReport, Gpu, GpuError, adapters, required_features, required_limits, wgpu,
};
