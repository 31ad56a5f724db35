//! Pictures of a window from a GPU.

use std::sync::Arc;

use sorb::{World, gpu::Gpu, render::View, scene::preset};
use sorb_view::{
    drawing::{CpuRenderer, WorldRenderer},
    gpu_renderer::GpuRenderer,
};

#[test]
fn a_picture_from_a_gpu_is_that_of_the_cpu() {
    let scene = preset("ball_drop").unwrap_or_else(|error| panic!("{error}"));
    let world = World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
    let camera = scene.viewpoint().into();
    let gpu = Arc::new(Gpu::new().unwrap_or_else(|error| panic!("{error}")));
    let mut device = GpuRenderer::new(&gpu);
    let mut drawn = |view: View| {
        let size = (96, 54);
        (
            device.draw(&world, &camera, view, size).pixels,
            CpuRenderer.draw(&world, &camera, view, size).pixels,
        )
    };
    let apart = |a: &[u8], b: &[u8]| {
        a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
    };
    let (particles, own) = drawn(View::Particles);
    assert_eq!(particles.len(), 3 * 96 * 54);
    let (near, far) = (apart(&particles, &own), apart(&particles, &drawn(View::Nodes).1));
    assert!(near < 1.0, "{near} levels");
    // The control: another view.
    assert!(far > 4.0 * near.max(0.5), "{far} levels");
    // One that is a program on the CPU is not taken by itself.
    assert_eq!(GpuRenderer::best(Some(&gpu)).is_some(), !gpu.report().is_software());
}
