//! Bytes of saves.

use sorb::World;

use super::common;

#[test]
#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn saves_are_small() {
    for name in super::busy::names() {
        let mut world = common::world(&common::preset(name, 1.0));
        for _ in 0..10 {
            common::frame(&mut world);
        }
        let (raw, packed) = sizes(&world);
        let (particles, nodes) = (world.particle_ids().len(), world.node_positions().len());
        let share = packed as f64 / raw as f64;
        println!("| {name} | {particles} | {nodes} | {raw} | {packed} | {share:.2} |");
        let largest = 64 * particles + 160 * nodes + 16_384;
        assert!(raw <= largest, "{name}: {raw} bytes for {particles} particles and {nodes} nodes");
    }
}

fn sizes(world: &World) -> (usize, usize) {
    let save = world.to_save().unwrap_or_else(|error| panic!("{error}"));
    let (mut raw, mut packed) = (Vec::new(), Vec::new());
    save.write(&mut raw).unwrap_or_else(|error| panic!("{error}"));
    save.write_compressed(&mut packed).unwrap_or_else(|error| panic!("{error}"));
    (raw.len(), packed.len())
}
