//! Known faults of drivers, as expectations: a test here fails when a fault is gone, and with it the reason for what is
//! done about it.

use std::{env, process::Command, sync::Arc};

use super::gpu;
use crate::gpu::{Gpu, wgpu};

/// A fault of the drivers whose name and version hold `driver`.
struct Fault {
    driver: &'static str,
    /// The test that shows it, in a process of its own, and that passes without the fault.
    shown_by: &'static str,
    /// What is done about it.
    remedy: &'static str,
}

const FAULTS: &[Fault] = &[Fault {
    driver: "Mesa 22.3",
    shown_by: "tests::gpu::faults::four_uniform_buffers",
    remedy: "no twin binds more than three uniform buffers",
}];

#[test]
fn known_faults_are_still_there() {
    let driver = &gpu().report().driver;
    for fault in FAULTS.iter().filter(|fault| driver.contains(fault.driver)) {
        let shown = run_apart(fault.shown_by);
        assert!(
            !shown,
            "{driver} no longer fails {}: {} no longer needs to be",
            fault.shown_by, fault.remedy
        );
    }
}

/// The control: a process of its own passes where nothing is wrong.
#[test]
fn what_is_right_passes_in_a_process_of_its_own() {
    assert!(run_apart("tests::gpu::faults::three_uniform_buffers"));
}

/// Whether a test that is ignored otherwise passes.
fn run_apart(test: &str) -> bool {
    let program = env::current_exe().unwrap_or_else(|error| panic!("{error}"));
    let output = Command::new(program).args(["--exact", test, "--ignored"]).output();
    let output = output.unwrap_or_else(|error| panic!("{error}"));
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(text.contains("running 1 test"), "there is no test {test}: {text}");
    output.status.success()
}

#[test]
#[ignore = "crashes with some drivers: `known_faults_are_still_there` runs it apart"]
fn four_uniform_buffers() {
    assert_eq!(sum_of_uniforms(4, 4, 48), 4 * 7);
}

#[test]
#[ignore = "`what_is_right_passes_in_a_process_of_its_own` runs it"]
fn three_uniform_buffers() {
    assert_eq!(sum_of_uniforms(3, 4, 48), 3 * 7);
}

/// The sum of numbers in as many uniform buffers of as many rows, each of them 7, beside storage buffers.
fn sum_of_uniforms(uniforms: u32, storage: u32, rows: usize) -> u32 {
    let gpu: Arc<Gpu> = Arc::clone(gpu());
    let (device, queue) = (gpu.device(), gpu.queue());
    let mut source = String::new();
    for k in 0..uniforms {
        source += &format!("@group(0) @binding({k}) var<uniform> u{k}: array<vec4<u32>, {rows}>;\n");
    }
    for k in uniforms..uniforms + storage {
        source += &format!("@group(0) @binding({k}) var<storage, read_write> s{k}: array<u32>;\n");
    }
    let sum: Vec<String> = (0..uniforms).map(|k| format!("u{k}[lane % {rows}u].x")).collect();
    let mut to: Vec<String> =
        (0..uniforms).map(|k| format!("if (u{k}[0].x + lane == 0u) {{ return; }}")).collect();
    to.push(format!("var sum = 0u; for (var k = 0u; k < u{}[1].y; k += 1u) {{ sum += 1u; }}", uniforms - 1));
    to.extend(
        (uniforms..uniforms + storage).map(|k| format!("s{k}[lane] = sum - 7u + {};", sum.join(" + "))),
    );
    source += &format!(
        "@compute @workgroup_size(256) fn main(@builtin(local_invocation_index) lane: u32) {{ {} }}",
        to.join(" ")
    );
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(source.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let buffer = |size, usage| {
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        device.create_buffer(&descriptor)
    };
    let (copied, read) = (wgpu::BufferUsages::COPY_DST, wgpu::BufferUsages::COPY_SRC);
    let mut buffers: Vec<_> =
        (0..uniforms).map(|_| buffer(rows as u64 * 16, wgpu::BufferUsages::UNIFORM | copied)).collect();
    let sevens = vec![7_u32; rows * 4];
    buffers.iter().for_each(|buffer| queue.write_buffer(buffer, 0, bytemuck::cast_slice(&sevens)));
    buffers.extend((0..storage).map(|_| buffer(1024, wgpu::BufferUsages::STORAGE | read)));
    let entries: Vec<_> = buffers
        .iter()
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
        .collect();
    let layout = pipeline.get_bind_group_layout(0);
    let bind = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    let answer = buffer(1024, wgpu::BufferUsages::MAP_READ | copied);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bind, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&buffers[uniforms as usize], 0, &answer, 0, 1024);
    queue.submit([encoder.finish()]);
    answer.map_async(wgpu::MapMode::Read, .., |_| {});
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap_or_else(|error| panic!("{error}"));
    let view = answer.get_mapped_range(..).unwrap_or_else(|error| panic!("{error}"));
    bytemuck::pod_collect_to_vec::<u8, u32>(&view)[255]
}
