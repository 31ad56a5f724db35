use super::*;
use crate::rigid::{ConvexHull, HullError, MAX_HULL_VERTICES, RapierEngine, RigidError, convex_hull};

/// Numbers between 0 and 1, the same on every run.
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    f32::from(u16::try_from(*state >> 16).expect("the shift leaves 16 bits")) / 65536.0
}

fn grid(count: u8, edge: f32, corner: Vec3) -> Vec<Vec3> {
    let at = |i: u8| f32::from(i) / f32::from(count - 1) * edge;
    let mut points = Vec::new();
    for i in 0..count {
        for j in 0..count {
            points.extend((0..count).map(|k| corner + Vec3::new(at(i), at(j), at(k))));
        }
    }
    points
}

/// Closed, centred, convex, without duplicate planes.
fn assert_sound(hull: &ConvexHull, points: &[Vec3]) {
    let Shape::Hull { planes, vertices, .. } = &hull.shape else { panic!("a hull has the shape of a hull") };
    let size = vertices.iter().map(|v| v.length()).fold(0.0, f32::max);
    for (index, (normal, offset)) in planes.iter().enumerate() {
        assert!((normal.length() - 1.0).abs() < 1e-6 && *offset > 0.0);
        assert!(vertices.iter().all(|v| normal.dot(*v) <= *offset), "a vertex lies outside");
        let slack = 2e-6 * (size + hull.offset.length());
        assert!(
            points.iter().all(|p| normal.dot(*p - hull.offset) <= *offset + slack),
            "a point lies outside"
        );
        let twin = planes[..index]
            .iter()
            .any(|(n, d)| n.dot(*normal) > 0.999_999_9 && (d - offset).abs() < 1e-6 * size);
        assert!(!twin, "plane {index} is there twice");
    }
}

#[test]
fn a_cube_has_six_planes() {
    for (count, edge, corner) in [
        (2, 1.0, Vec3::splat(-0.5)),
        (2, 0.01, Vec3::ZERO),
        (4, 0.02, Vec3::splat(0.3)),
        (5, 2.0, Vec3::splat(40.0)),
    ] {
        let points = grid(count, edge, corner);
        let hull = convex_hull(&points).expect("a cube is a solid");
        assert_sound(&hull, &points);
        assert_close(hull.offset, corner + Vec3::splat(edge / 2.0), 1e-6 * edge.max(corner.length()));
        let Shape::Hull { mut planes, .. } = hull.shape else { panic!("a hull has the shape of a hull") };
        assert_eq!(planes.len(), 6, "{count} points per edge of {edge} m: {planes:?}");
        planes.sort_by(|(a, _), (b, _)| {
            a.dot(Vec3::new(1.0, 2.0, 4.0)).total_cmp(&b.dot(Vec3::new(1.0, 2.0, 4.0)))
        });
        let normals = [Vec3::NEG_Z, Vec3::NEG_Y, Vec3::NEG_X, Vec3::X, Vec3::Y, Vec3::Z];
        for ((normal, offset), expected) in planes.into_iter().zip(normals) {
            assert_close(normal, expected, 1e-5);
            assert!((offset / (edge / 2.0) - 1.0).abs() < 1e-4, "offset {offset}");
        }
    }
}

#[test]
fn random_clouds_give_sound_hulls_that_rapier_takes() {
    let mut seed = 7;
    for round in 0..60_u8 {
        let count = 4 + usize::from(round) * 3;
        let scale = Vec3::new(1.0, 0.5, 0.2) * [0.005, 0.1, 3.0][usize::from(round % 3)];
        let points: Vec<Vec3> = (0..count)
            .map(|_| {
                let point = Vec3::new(random(&mut seed), random(&mut seed), random(&mut seed)) - 0.5;
                // Every other cloud lies on an ellipsoid: all points are corners.
                if round % 2 == 0 { point.normalize_or_zero() * scale } else { point * scale }
            })
            .collect();
        let Ok(hull) = convex_hull(&points) else {
            assert!(count < 8, "cloud {round} of {count} points has no hull");
            continue;
        };
        assert_sound(&hull, &points);
        let stone = body("stone", BodyKind::Dynamic, hull.shape, Vec3::Y * 10.0);
        let floor = body("floor", BodyKind::Fixed, Shape::Plane, Vec3::ZERO);
        let mut engine = RapierEngine::new(GRAVITY, None, &[stone, floor]).expect("rapier3d takes the hull");
        step(&mut engine, 0.01, 2);
    }
}

#[test]
fn a_fine_ball_is_a_hull_too() {
    let mut seed = 3;
    let points: Vec<Vec3> = (0..MAX_HULL_VERTICES)
        .map(|_| {
            (Vec3::new(random(&mut seed), random(&mut seed), random(&mut seed)) - 0.5).normalize_or_zero()
                * 0.03
        })
        .collect();
    let hull = convex_hull(&points).expect("a ball is a solid");
    assert_sound(&hull, &points);
    let ball = body("ball", BodyKind::Dynamic, hull.shape, Vec3::Y * 0.03);
    let floor = body("floor", BodyKind::Fixed, Shape::Plane, Vec3::ZERO);
    let mut engine = RapierEngine::new(GRAVITY, None, &[ball, floor]).expect("rapier3d takes the hull");
    step(&mut engine, 0.01, 50);
    assert!((engine.state(0).position.y - 0.03).abs() < 5e-4, "{}", engine.state(0).position);
}

#[test]
fn degenerate_points_have_no_hull() {
    let cube = grid(2, 0.1, Vec3::ZERO);
    let flat: Vec<Vec3> = cube.iter().map(|p| Vec3::new(p.x, p.y, 0.3 * p.x - p.y)).collect();
    let thin: Vec<Vec3> = cube.iter().map(|p| *p * Vec3::new(1.0, 1.0, 5e-4)).collect();
    let line: Vec<Vec3> = (0..9_u8).map(|i| Vec3::new(1.0, 2.0, 3.0) * f32::from(i)).collect();
    assert_eq!(convex_hull(&flat), Err(HullError::Flat));
    assert_eq!(convex_hull(&thin), Err(HullError::Flat));
    assert_eq!(convex_hull(&line), Err(HullError::Flat));
    assert_eq!(convex_hull(&[]), Err(HullError::TooFewPoints { found: 0 }));
    let twice = [cube[0], cube[1], cube[2], cube[0], -cube[0]];
    assert_eq!(convex_hull(&twice), Err(HullError::TooFewPoints { found: 3 }));
    let mut broken = cube.clone();
    broken[5].y = f32::NAN;
    assert!(matches!(convex_hull(&broken), Err(HullError::NotFinite { index: 5, .. })));
    let mut seed = 1;
    let many: Vec<Vec3> = (0..3 * MAX_HULL_VERTICES)
        .map(|_| {
            (Vec3::new(random(&mut seed), random(&mut seed), random(&mut seed)) - 0.5).normalize_or_zero()
        })
        .collect();
    assert!(
        matches!(convex_hull(&many), Err(HullError::TooManyVertices { found }) if found > MAX_HULL_VERTICES)
    );
}

#[test]
fn a_foreign_hull_is_checked() {
    let hull = convex_hull(&grid(2, 0.1, Vec3::ZERO)).expect("a cube is a solid");
    let Shape::Hull { planes, vertices, triangles } = hull.shape else {
        panic!("a hull has the shape of a hull")
    };
    let refusal = |planes: &[(Vec3, f32)], vertices: &[Vec3], triangles: &[[u32; 3]]| {
        let (planes, vertices, triangles) = (planes.to_vec(), vertices.to_vec(), triangles.to_vec());
        let stone = body("stone", BodyKind::Dynamic, Shape::Hull { planes, vertices, triangles }, Vec3::ZERO);
        match RapierEngine::new(GRAVITY, None, &[stone]) {
            Err(RigidError::Hull { body, source }) if body == "stone" => Some(source),
            Err(error) => panic!("another error: {error}"),
            Ok(_) => None,
        }
    };
    assert_eq!(refusal(&planes, &vertices, &triangles), None);
    let shifted: Vec<Vec3> = vertices.iter().map(|v| *v + Vec3::X * 0.01).collect();
    assert!(matches!(refusal(&planes, &shifted, &triangles), Some(HullError::NotCentred { .. })));
    assert_eq!(refusal(&planes, &vertices, &triangles[1..]), Some(HullError::NotClosed));
    let inside_out: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert_eq!(refusal(&planes, &vertices, &inside_out), Some(HullError::NotClosed));
    assert_eq!(refusal(&planes[..3], &vertices, &triangles), Some(HullError::NotClosed));
    assert_eq!(refusal(&planes, &vertices[..3], &[]), Some(HullError::TooFewPoints { found: 3 }));
    let flat: Vec<Vec3> = vertices.iter().map(|v| *v * Vec3::new(1.0, 1.0, 0.0)).collect();
    assert_eq!(refusal(&planes, &flat, &triangles), Some(HullError::Flat));
}
