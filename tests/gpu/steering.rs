//! Sponges and bodies that come, go and change on a device. The same bits twice and after a restore, and within the
//! bounds of parity those of the CPU.

use sorb::{
    Command, Offload, Options, World,
    glam::{Quat, UVec3, Vec3},
    scene::{Body, Fluid, FluidBlock, Material, Scene, ShapeKind, Sponge},
};

use super::{common, difference, gpu, world};

const LOW: Vec3 = Vec3::new(-0.05, 0.0, -0.05);
const HIGH: Vec3 = Vec3::new(0.05, 0.15, 0.05);

fn scene() -> Scene {
    let blocks = vec![FluidBlock::new(LOW, HIGH.with_y(0.02))];
    let fluid = Fluid { spacing: 0.007, blocks, ..Fluid::default() };
    let sponge = |name: &str, position| Sponge { cells: UVec3::splat(3), ..Sponge::new(name, position) };
    let wet = Sponge { saturation: 1.0, ..sponge("wet", Vec3::new(-0.045, 0.03, -0.045)) };
    let dry = sponge("dry", Vec3::new(0.01, 0.03, 0.01));
    Scene::new("pool").in_box(LOW, HIGH).with_fluid(fluid).with_sponge(wet).with_sponge(dry)
}

/// A sponge comes, and another goes.
fn sponges(world: &mut World, frame: u32) {
    let cells = UVec3::new(3, 2, 4);
    let description = Sponge { cells, saturation: 0.5, ..Sponge::new("new", Vec3::new(0.0, 0.1, 0.0)) };
    let description = Box::new(description);
    let command = match frame {
        3 => Command::AddSponge { sponge: world.next_sponge(), description },
        6 => Command::RemoveSponge { sponge: 0.into() },
        _ => return,
    };
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

/// A ball comes and goes.
fn bodies(world: &mut World, frame: u32) {
    let shape = ShapeKind::Sphere { radius: 0.012 };
    let description = Box::new(Body::dynamic("ball", shape, Vec3::new(0.03, 0.06, -0.03), 1500.0));
    let command = match frame {
        0 => Command::AddBody { body: world.next_body(), description },
        5 => Command::RemoveBody { body: 0.into() },
        _ => return,
    };
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
}

fn advance(world: &mut World, frame: u32) {
    let (position, rotation) = (Vec3::new(-0.02, 0.11, -0.02), Quat::from_rotation_x(0.2));
    let soft = Material { young_modulus: 5000.0, softening: 0.5, permeability: 4e-9, ..Material::default() };
    let command = match frame {
        1 => Command::PlaceSponge { sponge: 0.into(), position, rotation, velocity: Vec3::X * 0.3 },
        2 => Command::Material { sponge: 1.into(), material: soft },
        4 => Command::Material { sponge: 1.into(), material: Material::default() },
        _ => {
            bodies(world, frame);
            sponges(world, frame);
            return common::frame(world);
        }
    };
    world.push(command).unwrap_or_else(|error| panic!("{error}"));
    common::frame(world);
}

#[test]
fn sponges_materials_and_bodies_are_as_on_the_cpu() {
    let scene = scene();
    let (mut on_cpu, mut on_gpu) = (world(&scene, Offload::Cpu), world(&scene, Offload::Gpu));
    let (mut twice, mut restored) = (on_gpu.clone(), on_gpu.clone());
    let options = Options { offload: Offload::Gpu, gpu: Some(gpu()), ..Options::default() };
    for frame in 0..9 {
        [&mut on_cpu, &mut on_gpu, &mut twice].into_iter().for_each(|world| advance(world, frame));
        let mut bytes = Vec::new();
        restored.save(&mut bytes).unwrap_or_else(|error| panic!("{error}"));
        restored = World::restore(&bytes[..], &options).unwrap_or_else(|error| panic!("{error}"));
        advance(&mut restored, frame);
        assert_eq!(on_gpu.digest(), twice.digest(), "frame {frame}");
        assert_eq!(on_gpu.digest(), restored.digest(), "frame {frame}");
        assert_eq!(on_gpu.ledger().lost, 0);
    }
    let apart = difference(&on_cpu.measures(), &on_gpu.measures());
    assert!(apart.0 < 0.05, "{apart:?}");
    // The control: without commands.
    let mut without = world(&scene, Offload::Gpu);
    (0..9).for_each(|_| common::frame(&mut without));
    let apart = difference(&on_gpu.measures(), &without.measures());
    assert!(apart.0 > 0.2, "{apart:?}");
}
