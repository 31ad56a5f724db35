use super::super::*;
use super::full;

/// The scene with all keys that a quality changes far from every quality.
fn off() -> Scene {
    let keys = [
        "time.maximum_step=0.003",
        "time.courant=0.3",
        "fluid.density_tolerance=0.05",
        "fluid.rounds=7",
        "fluid.support=2.2",
    ];
    let scene = full().with_overrides(keys).expect("valid");
    scene.with_overrides(["sponges[0].iterations=3"]).expect("valid")
}

#[test]
fn balanced_is_the_defaults() {
    assert_eq!(Quality::default(), Quality::Balanced);
    assert_eq!(off().with_quality(Quality::Balanced).expect("valid"), full());
    for other in [Quality::Fast, Quality::Accurate] {
        assert_ne!(off().with_quality(other).expect("valid"), full(), "{other}");
    }
}

#[test]
fn a_quality_changes_what_it_says_and_nothing_else() {
    for quality in Quality::ALL {
        let scene = off().with_quality(quality).expect("valid");
        // Key by key, by another way: changing it back gives what was there.
        let keys: Vec<String> = quality.changes(&off());
        let before = [
            "time.maximum_step=0.003",
            "time.courant=0.3",
            "fluid.density_tolerance=0.05",
            "fluid.rounds=7",
            "fluid.support=2.2",
        ];
        let before: Vec<&str> = before.into_iter().chain(["sponges[0].iterations=3"]).collect();
        let key = |text: &str| text.split('=').next().map(str::to_owned);
        assert!(keys.iter().all(|change| before.iter().any(|old| key(old) == key(change))), "{keys:?}");
        assert_eq!(scene.with_overrides(before.iter().copied()).expect("valid"), off(), "{quality}");
        for left_out in 0..keys.len() {
            let some = keys.iter().enumerate().filter(|(index, _)| *index != left_out);
            let partly = off().with_overrides(some.map(|(_, change)| change.as_str())).expect("valid");
            assert_ne!(partly, scene, "{} changes nothing", keys[left_out]);
        }
    }
}

#[test]
fn work_rises_from_quality_to_quality() {
    let scenes = Quality::ALL.map(|quality| full().with_quality(quality).expect("valid"));
    for pair in scenes.windows(2) {
        let [less, more] = pair else { panic!("two") };
        let (Some(loose), Some(tight)) = (&less.fluid, &more.fluid) else { panic!("water") };
        assert!(less.sponges[0].iterations < more.sponges[0].iterations);
        assert!(loose.density_tolerance >= tight.density_tolerance);
        assert!(less.time.courant >= more.time.courant && loose.support <= tight.support);
        assert!(less.time.maximum_step >= more.time.maximum_step);
    }
}

#[test]
fn solvers_whose_iterations_are_the_material_keep_them() {
    let paper = ["fluid.solver=wcsph", "sponges[0].solver=sbd", "sponges[0].iterations=1"];
    let scene = full().with_overrides(paper).expect("valid");
    let fast = scene.with_quality(Quality::Accurate).expect("valid");
    assert_eq!((&fast.sponges, &fast.fluid), (&scene.sponges, &scene.fluid));
    assert_ne!(fast.time, scene.time);
    let dry = Scene { fluid: None, sponges: Vec::new(), ..full() };
    assert!(Quality::Fast.changes(&dry).iter().all(|change| change.starts_with("time.")));
}

#[test]
fn names_are_read_and_wrong_ones_answered() {
    for quality in Quality::ALL {
        assert_eq!(quality.name().parse(), Ok(quality));
    }
    let error = "acurate".parse::<Quality>().expect_err("no such quality");
    assert!(
        error.contains("did you mean `accurate`?") && error.contains("fast, balanced, accurate"),
        "{error}"
    );
    assert!("".parse::<Quality>().is_err() && "Fast".parse::<Quality>().is_err());
}

#[test]
fn a_step_that_is_too_short_for_the_scene_is_refused() {
    let scene = full().with_overrides(["time.minimum_step=0.002"]).expect("valid");
    assert!(scene.with_quality(Quality::Balanced).is_ok());
    let error = scene.with_quality(Quality::Accurate).expect_err("below the shortest step").to_string();
    assert!(error.contains("minimum_step"), "{error}");
}
