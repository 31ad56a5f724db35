//! Pictures of worlds on the GPU.

use sorb::{
    Offload, World,
    render::{Image, View, draw_world},
};

use super::{busy, common, world};

const FRAMES: u32 = 12;

fn picture(world: &World) -> Image {
    draw_world(world, &world.scene().viewpoint().into(), View::Particles, 320, 180)
}

/// Share of the pixels that differ by more than 8 of 255 in a channel.
fn difference(a: &Image, b: &Image) -> f64 {
    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 8);
    let pixels = a.pixels.chunks(3).zip(b.pixels.chunks(3));
    pixels.clone().filter(differs).count() as f64 / pixels.count() as f64
}

#[test]
fn they_are_those_of_the_cpu() {
    for name in ["ball_drop", "ball_drop_paper"] {
        let scene = busy::scene(name, 0.3);
        let [cpu, gpu] = [Offload::Cpu, Offload::Gpu].map(|offload| {
            let mut world = world(&scene, offload);
            let start = picture(&world);
            (0..FRAMES).for_each(|_| common::frame(&mut world));
            (start, picture(&world))
        });
        let found = difference(&cpu.1, &gpu.1);
        assert!(found < 1e-3, "{name}: {found:.1e} of the pixels differ");
        // Negative control: the picture of the beginning is another one.
        assert!(difference(&cpu.1, &cpu.0) > 1e-2, "{name}");
    }
}
