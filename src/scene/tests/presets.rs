use super::super::*;

/// Fluid particles and sponge nodes that the default sizes aim at.
const SIZES: [(&str, u64, u64); 14] = [
    ("standing", 8192, 1024),
    ("ball_drop", 8192, 1024),
    ("squish", 8192, 1024),
    ("dam_break", 8192, 512),
    ("wring", 8192, 1024),
    ("wipe", 7168, 1024),
    ("life", 14_336, 1024),
    ("stack", 7168, 1118),
    ("bobbing", 12_288, 0),
    ("tap", 0, 512),
    ("cup", 0, 640),
    ("water", 8192, 0),
    ("dry", 0, 1024),
    ("empty", 0, 0),
];

#[test]
fn every_preset_is_valid_and_has_the_stated_size() {
    assert_eq!(presets().len(), SIZES.len());
    for (known, (name, particles, nodes)) in presets().iter().zip(SIZES) {
        let scene = preset(name).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((known.name, known.title), (scene.name.as_str(), scene.title.as_str()));
        let estimate = scene.estimate();
        assert!(estimate.particles.abs_diff(particles) * 4 <= particles, "{name}: {estimate:?}");
        assert!(estimate.nodes.abs_diff(nodes) * 4 <= nodes, "{name}: {estimate:?}");
    }
}

#[test]
fn every_preset_can_be_refined_and_coarsened() {
    for known in presets() {
        let scene = preset(known.name).unwrap_or_else(|error| panic!("{error}"));
        let count = scene.estimate().particles as f64;
        // A bar of 5 cells cannot become thinner than 2, so only validity is asked of the coarsest.
        for (resolution, slack) in
            [(0.25, 2.0), (0.5, 0.5), (0.8, 0.2), (1.5, 0.25), (2.0, 0.15), (4.0, 0.25)]
        {
            let scaled = scene.scaled(resolution).unwrap_or_else(|error| panic!("{error}"));
            let expected = count * f64::from(resolution).powi(3);
            let particles = scaled.estimate().particles as f64;
            let error = (particles - expected).abs();
            assert!(error <= slack * expected, "{} x {resolution}: {particles}, not {expected}", known.name);
        }
    }
}

#[test]
fn grips_hold_the_ends_of_the_bar_and_nothing_else() {
    let scene = preset("wring").unwrap_or_else(|error| panic!("{error}"));
    let bar = &scene.sponges[0];
    for body in &scene.bodies {
        assert!(body.grip);
        let ShapeKind::Cuboid { half_extents } = body.shape else { panic!("grips are cuboids") };
        let held = (0..=bar.cells.x)
            .map(|layer| bar.position.x + layer as f32 * bar.edge)
            .filter(|x| (x - body.position.x).abs() <= half_extents.x);
        assert_eq!(held.count(), 2, "both layers of nodes of the last cells");
    }
    let scene = preset("wipe").unwrap_or_else(|error| panic!("{error}"));
    let (sponge, pad) = (&scene.sponges[0], &scene.bodies[0]);
    let ShapeKind::Cuboid { half_extents } = pad.shape else { panic!("the pad is a cuboid") };
    let wider = half_extents - 0.5 * (sponge.maximum() - sponge.position);
    assert!(wider.x > 0.0 && wider.z > 0.0, "the pad covers the sponge: {wider}");
    let held = (0..=sponge.cells.y)
        .map(|layer| sponge.position.y + layer as f32 * sponge.edge)
        .filter(|y| (y - pad.position.y).abs() <= half_extents.y);
    assert_eq!(held.count(), 1, "the upper layer of nodes, and the middles of the cells below it");
}

#[test]
fn scripts_start_after_the_scene_has_settled() {
    for known in presets() {
        let scene = preset(known.name).unwrap_or_else(|error| panic!("{error}"));
        for motion in scene.bodies.iter().flat_map(|body| &body.motions) {
            assert!(
                motion.interval().0 >= 0.3 && motion.interval().1 < scene.time.duration,
                "{}",
                known.name
            );
        }
    }
    let squish = preset("squish").unwrap_or_else(|error| panic!("{error}"));
    let gap =
        |time| squish.bodies[1].state_at(time).position.x - squish.bodies[0].state_at(time).position.x - 0.01;
    assert!((gap(0.0) - 0.09).abs() < 1e-6);
    assert!((gap(1.0) - 0.04).abs() < 1e-6, "half the thickness of the sponge");
    assert!((gap(3.0) - 0.09).abs() < 1e-6);
}

#[test]
fn an_unknown_preset_proposes_the_nearest() {
    let error = preset("dambreak").expect_err("no such preset").to_string();
    assert!(
        error.starts_with("unknown preset `dambreak`; did you mean `dam_break`?; presets: standing, "),
        "{error}"
    );
    assert!(
        preset("quux")
            .expect_err("no such preset")
            .to_string()
            .starts_with("unknown preset `quux`; presets:")
    );
}
