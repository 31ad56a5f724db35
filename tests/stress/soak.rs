//! The scenes of the library for a long time: two seconds, or ten minutes in the long form.

use sorb::World;

use crate::{common, pick};

/// Coarse: `tests/scenes` runs the scenes at half the resolution of the library.
const RESOLUTION: f32 = 0.4;

#[expect(clippy::print_stdout, reason = "the table of the documentation")]
fn soak(name: &str) {
    let scene = common::preset(name, RESOLUTION);
    let mut world = World::new(&scene).unwrap_or_else(|error| panic!("{name}: {error}"));
    let (particles, mass) = (world.particle_ids().len(), world.measures().water_mass);
    let seconds = pick(2, 600);
    let (mut fastest, mut last, mut steps) = (0.0_f32, 0.0_f32, 0);
    for frame in 1..=60 * seconds {
        let report = world.advance_frame().unwrap_or_else(|error| panic!("{name}: {error}"));
        steps += u64::from(report.steps);
        fastest = fastest.max(report.maximum_speed);
        if frame > 54 * seconds {
            last = last.max(report.maximum_speed);
        }
        if frame % 60 == 0 {
            if scene.emitters.is_empty() {
                assert_eq!(common::unhealthy(&world, particles), None, "{name}: frame {frame}");
            } else {
                let ledger = world.ledger();
                let present = ledger.seeded + ledger.poured - ledger.drained;
                assert_eq!((ledger.lost, ledger.present), (0, present), "{name}: frame {frame}");
            }
        }
    }
    let measures = world.measures();
    println!(
        "| {name} | {:.0} s | {steps} | {fastest:.2} m/s | {last:.3} m/s | {:.2e} J |",
        measures.time, measures.kinetic_energy
    );
    if scene.emitters.is_empty() {
        assert_eq!(measures.water_mass.to_bits(), mass.to_bits(), "{name}");
    }
    assert!(fastest < 5.0, "{name}: something moved at {fastest} m/s");
    assert!((measures.time - f64::from(seconds)).abs() < 1e-6, "{name}: ends at {} s", measures.time);
}

macro_rules! scenes {
    ($($scene:ident)+) => {
        $(#[test]
        fn $scene() {
            soak(stringify!($scene));
        })+
    };
}
sorb::for_every_preset!(scenes);
