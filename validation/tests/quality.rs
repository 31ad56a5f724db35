//! Qualities of scenes: more work reduces the error, and less work increases it.

use sorb::scene::Quality;
use sorb_validation::{CASES, Setting, run};

/// Error of the first figure of a quick case whose name has a prefix.
fn error(case: &str, figure: &str, resolution: f64, quality: Quality) -> f64 {
    let case = CASES.iter().find(|known| known.name == case).copied().expect("a case of that name");
    let setting = Setting { resolution, quick: true, quality: Some(quality), ..Setting::new() };
    let figures = run(case, &setting).figures.expect("the case runs");
    figures.iter().find(|known| known.name.starts_with(figure)).expect("a figure of that name").error
}

/// A dam of eight particles over its base.
#[test]
fn water_keeps_its_volume_better_at_every_quality() {
    let [fast, balanced, accurate] =
        Quality::ALL.map(|quality| error("dam_break", "change of volume", 1.0, quality));
    // The tolerance is a tenth, but the permitted compression is the same (docs/pressure-solve.md). Negative control: the
    // comparison of balanced with itself fails.
    assert!(accurate < 0.9 * balanced, "{accurate}, {balanced}");
    assert!(accurate < 0.9 * fast, "{accurate}, {fast}");
    let again = error("dam_break", "change of volume", 1.0, Quality::Balanced);
    assert!(again.to_bits() == balanced.to_bits(), "{again}, {balanced}");
}
