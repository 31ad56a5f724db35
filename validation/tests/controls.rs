//! Every case at a small size, as it is and with its planted fault.

use sorb_validation::{CASES, Case, Figure, KNOWN_MISSES, Setting, Verdict, run};

/// Coarser than quick: this runs with every test.
fn setting(case: &Case, fault: bool) -> Setting {
    // Cases that take ten times as long as others.
    let resolution = match case.name {
        "rest" => 0.5,
        "consolidation" | "dam_spheric" | "softening" | "swelling" => 0.75,
        _ => 1.0,
    };
    Setting { resolution, quick: true, fault, ..Setting::new() }
}

fn figures(case: &'static Case, fault: bool) -> Vec<Figure> {
    let setting = setting(case, fault);
    let outcome = run(case, &setting);
    let figures =
        outcome.figures.as_ref().unwrap_or_else(|error| panic!("{}, fault {fault}: {error}", case.name));
    if !fault && setting.resolution == 1.0 {
        let is_out =
            |figure: &&Figure| figure.verdict() == Verdict::Miss && outcome.known(&figure.name).is_none();
        let out: Vec<_> = figures.iter().filter(is_out).collect();
        assert!(out.is_empty(), "{}: {out:#?}", case.name);
    }
    figures.clone()
}

/// At the size of quick runs every figure is in bounds, or a known miss. The fault pushes one out of its bounds, and well beyond its error
/// without the fault.
fn is_caught(name: &str) {
    let case = CASES.iter().find(|case| case.name == name).unwrap_or_else(|| panic!("no case {name}"));
    let (sound, faulty) = (figures(case, false), figures(case, true));
    assert_eq!(sound.len(), faulty.len(), "{name}");
    let caught = |(sound, faulty): (&Figure, &Figure)| {
        faulty.error.is_finite() && faulty.error > faulty.bound && faulty.error > 1.5 * sound.error
    };
    assert!(
        sound.iter().zip(&faulty).any(caught),
        "{name} does not notice: {}\n{sound:#?}\n{faulty:#?}",
        case.control
    );
}

macro_rules! caught {
    ($($name:ident)*) => {
        $(#[test]
        fn $name() {
            is_caught(stringify!($name));
        })*

        #[test]
        fn every_case_is_here() {
            let here = [$(stringify!($name)),*];
            let all: Vec<_> = CASES.iter().map(|case| case.name).collect();
            assert_eq!(all, here);
        }
    };
}

caught! {
    hydrostatic
    dam_break
    dam_spheric
    taylor_green
    floating
    sinking
    shear_wave
    slope
    sloshing
    u_tube
    litre
    splash
    drop
    bridge
    channel
    honey
    patch
    cantilever
    uniaxial
    confined
    torsion
    squash
    vibration
    washburn
    imbibition
    permeameter
    consolidation
    momentum
    squeeze
    swelling
    softening
    drainage
    receding
    everyday_water
    everyday_bodies
    everyday_sponges
    rest
}

#[test]
fn known_misses_name_cases_that_there_are() {
    for miss in KNOWN_MISSES {
        assert!(CASES.iter().any(|case| case.name == miss.case), "{miss:?}");
    }
}
