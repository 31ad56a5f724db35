//! A sponge absorbs water: build a scene in code, step it, read its state.
// Prints: ^[0-9.]+ g of [0-9.]+ g of water absorbed$

use sorb::{
    World,
    glam::{UVec3, Vec3},
    scene::{Fluid, FluidBlock, Scene, Sponge},
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (low, high) = (Vec3::new(-0.06, 0.0, -0.06), Vec3::new(0.06, 0.1, 0.06));
    let water = FluidBlock::new(low, Vec3::new(0.06, 0.02, 0.06));
    let sponge = Sponge { cells: UVec3::splat(4), ..Sponge::new("sponge", Vec3::new(-0.02, 0.0, -0.02)) };
    let scene = Scene::new("bath")
        .in_box(low, high)
        .with_fluid(Fluid { blocks: vec![water], ..Fluid::default() })
        .with_sponge(sponge);

    let mut world = World::new(&scene)?;
    for _ in 0..30 {
        world.advance_frame()?;
    }

    let measures = world.measures();
    #[expect(clippy::print_stdout, reason = "an example shows its result")]
    {
        println!(
            "{:.1} g of {:.1} g of water absorbed",
            measures.absorbed_mass * 1e3,
            measures.water_mass * 1e3
        );
    }
    assert!(measures.absorbed_mass > 0.01, "the sponge drinks");
    assert!(measures.saturation < 1.5 && measures.mean_density_error < 0.05, "and the water stays water");
    Ok(())
}
