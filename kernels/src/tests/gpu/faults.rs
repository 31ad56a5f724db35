//! Known faults of drivers and of what is between them and us, as expectations. A test here fails when a fault is gone,
//! and with it the reason for what is done about it.

use super::gpu;
use crate::gpu::{Gpu, wgpu};

struct Fault {
    /// Part of the name and version of the drivers that have it; empty for all.
    driver: &'static str,
    what: &'static str,
    /// What is done about it.
    remedy: &'static str,
    is_there: fn(&Gpu) -> bool,
}

const FAULTS: &[Fault] = &[Fault {
    driver: "",
    what: "naga 30 refuses `enable subgroups;`, which WGSL asks for before subgroup operations",
    remedy: "`scan_subgroup.wgsl` goes without",
    is_there: |gpu| is_refused(gpu, "enable subgroups;\n"),
}];

/// Whether a shader that begins like this is refused.
fn is_refused(gpu: &Gpu, begin: &str) -> bool {
    let rest = "@compute @workgroup_size(1) fn main() {}";
    let scope = gpu.device().push_error_scope(wgpu::ErrorFilter::Validation);
    let _ = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("fault"),
        source: wgpu::ShaderSource::Wgsl(format!("{begin}{rest}").into()),
    });
    pollster::block_on(scope.pop()).is_some()
}

#[test]
fn known_faults_are_still_there() {
    let driver = &gpu().report().driver;
    for fault in FAULTS.iter().filter(|fault| driver.contains(fault.driver)) {
        assert!((fault.is_there)(gpu()), "{driver}, no longer: {}; {}", fault.what, fault.remedy);
    }
}

/// Negative control: what is right is not refused.
#[test]
fn what_is_right_is_not_refused() {
    assert!(!is_refused(gpu(), ""));
}
