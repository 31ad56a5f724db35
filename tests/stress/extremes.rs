//! Every key of the sponge, the water and the time at both ends of its range, one at a time.

use sorb::scene::{Scene, SceneError, limits};

use crate::{
    case::{Case, Check, table},
    common, pick,
    scenes::{wet, with_ball},
};

/// A scene with one key at an end of its range; `None` where that does not fit the rest of the scene.
fn at_the_end(key: &str, value: f32) -> Option<Scene> {
    let scene = with_ball(wet(), 2000.0, 0.0);
    let text = if value.fract() == 0.0
        && matches!(key, "fluid.rounds" | "fluid.viscosity_rounds" | "sponges[].iterations")
    {
        format!("{}={value}", key.replace("[]", "[0]"))
    } else {
        format!("{}={value:e}", key.replace("[]", "[0]"))
    };
    match scene.with_overrides([text.as_str()]) {
        Ok(scene) => Some(scene),
        Err(SceneError::Invalid { problems, .. }) => {
            // Refused with the name of a key: that of the value or of the other side of a rule.
            assert!(problems.iter().all(|problem| !problem.key.is_empty()), "{text}");
            None
        }
        Err(error) => panic!("{text}: {error}"),
    }
}

/// A damping time of ten seconds, after 0.3 s.
const DAMPED: &[(Check, &str)] =
    &[(Check::Energy, "not known yet: 8 times the energy at a damping time of 10 s, at 3 m/s at most")];

#[test]
fn every_key_at_both_ends() {
    let mut cases = Vec::new();
    let scalar = |key: &str| {
        let vectors = ["cells", "position", "velocity", "minimum", "maximum"];
        !vectors.contains(&key.rsplit('.').next().unwrap_or(key))
    };
    for limit in limits() {
        let part = ["fluid.", "sponges[].", "time."].iter().any(|table| limit.key.starts_with(table));
        if !part || limit.key.starts_with("fluid.blocks") || !scalar(limit.key) {
            continue;
        }
        for value in [limit.minimum, limit.maximum] {
            let Some(scene) = at_the_end(limit.key, value) else { continue };
            // This one requires a million steps per second.
            let seconds = if scene.time.maximum_step < 1e-5 { pick(1e-3, 0.02) } else { pick(0.02, 0.3) };
            let case = Case::new(format!("wet: {} = {value:e}", limit.key), scene, seconds);
            let is_stiff = limit.key == "sponges[].damping" && value > 1.0;
            let known = if is_stiff { pick(&[][..], DAMPED) } else { &[] };
            cases.push(Case { fastest: 20.0, known, ..case });
        }
    }
    assert!(cases.len() > 40, "only {} keys can be at the end of their range", cases.len());
    table(cases);
}

#[test]
fn a_box_of_two_kilometres_is_no_more_work() {
    let keys = ["domain.minimum=[-1000, 0, -1000]", "domain.maximum=[1000, 1000, 1000]"];
    let far = common::with(&wet(), &keys);
    let open = common::with(&wet(), &["domain={kind=\"open\"}"]);
    table([
        Case::new("wet: a box of 2 km", far, pick(0.1, 1.0)),
        Case { fastest: 20.0, excess: None, ..Case::new("wet: no box, free fall", open, pick(0.1, 1.0)) },
    ]);
}
