//! Optics against formulas, the tree against all shapes, and pores at edges.

use super::optics::{INDEX, Medium, reflect, refract, schlick};
use super::tree::{Ball, Shape, Tree, Triangle};
use crate::render::colour::{colour_map, displayed, unit};
use glam::Vec3;

#[test]
fn light_is_bent_and_mirrored_as_fresnel_says() {
    let upright = refract(Vec3::NEG_Y, Vec3::Y, 1.0 / INDEX).expect("it enters");
    let expected = ((INDEX - 1.0) / (INDEX + 1.0)) * ((INDEX - 1.0) / (INDEX + 1.0));
    assert!((upright.1 - expected).abs() < 1e-6 && upright.0.distance(Vec3::NEG_Y) < 1e-6);
    let slanted = Vec3::new(0.6, -0.8, 0.0);
    let (below, share) = refract(slanted, Vec3::Y, 1.0 / INDEX).expect("it enters");
    assert!((below.x * INDEX - 0.6).abs() < 1e-5, "Snell's law");
    let (back, again) = refract(-below, Vec3::NEG_Y, INDEX).expect("it leaves");
    assert!(back.distance(-slanted) < 1e-5 && (share - again).abs() < 1e-5, "the way back is the same");
    // The critical angle is 48.6 degrees.
    assert!(refract(Vec3::new(0.76, 0.65, 0.0).normalize(), Vec3::NEG_Y, INDEX).is_none());
    assert!(refract(Vec3::new(0.74, 0.672, 0.0).normalize(), Vec3::NEG_Y, INDEX).is_some());
    assert!(reflect(slanted, Vec3::Y).distance(Vec3::new(0.6, 0.8, 0.0)) < 1e-6);
    assert!((schlick(0.02, 1.0) - 0.02).abs() < 1e-6 && (schlick(0.02, 0.0) - 1.0).abs() < 1e-6);
}

#[test]
fn absorption_goes_by_metres() {
    let medium = Medium { absorption: Vec3::new(8.0, 2.0, 1.0), scatter: Vec3::ZERO };
    let (once, twice) = (medium.left(0.1), medium.left(0.2));
    assert!((once * once).distance(twice) < 1e-6 && (once.x - 0.449_329).abs() < 1e-5);
}

/// A direction from a number.
fn direction(key: u32) -> Vec3 {
    Vec3::new(unit(key), unit(key + 1), unit(key + 2)) - 0.5
}

fn compare<S: Shape + Copy>(shapes: &[S]) -> (usize, usize) {
    let tree = Tree::new(shapes.iter().copied());
    let part = Tree::new(shapes.iter().copied().take(shapes.len() - 20));
    let (mut hits, mut lost) = (0, 0);
    for ray in 0..2000 {
        let origin = direction(90_000 + 7 * ray) * 3.0;
        let towards = (direction(20_000 + 5 * ray) - origin).normalize();
        let nearest = shapes.iter().filter_map(|shape| shape.meet(origin, towards, f32::INFINITY));
        let expected = nearest.map(|(distance, _)| distance).reduce(f32::min);
        let found = tree.hit(origin, towards, f32::INFINITY).map(|hit| hit.distance);
        assert_eq!(found, expected);
        hits += usize::from(found.is_some());
        lost += usize::from(part.hit(origin, towards, f32::INFINITY).map(|hit| hit.distance) != expected);
    }
    (hits, lost)
}

#[test]
fn the_tree_finds_the_nearest_of_all_shapes() {
    let triangles: Vec<Triangle> = (0..300)
        .map(|key| {
            let corner = direction(31 * key);
            [corner, corner + 0.3 * direction(31 * key + 3), corner + 0.3 * direction(31 * key + 6)]
        })
        .collect();
    let balls: Vec<Ball> = (0..300).map(|key| (direction(17 * key), 0.02 + 0.05 * unit(key))).collect();
    for (hits, lost) in [compare(&triangles), compare(&balls)] {
        // Negative control: without a few shapes, some rays end elsewhere.
        assert!(hits > 200 && lost > 0, "{hits} {lost}");
    }
}

#[test]
fn displayed_colours_grow_with_the_light_and_maps_have_two_ends() {
    let shades: Vec<f32> = (0..100).map(|step| displayed(Vec3::splat(step as f32 * 0.03)).x).collect();
    assert!(shades.windows(2).all(|pair| pair[1] >= pair[0]));
    assert!(shades[0] == 0.0 && *shades.last().expect("a shade") > 0.9);
    assert_eq!(colour_map(-1.0), colour_map(0.0));
    assert_eq!(colour_map(f32::NAN), colour_map(0.0));
    assert!(colour_map(1.0).distance(colour_map(0.0)) > 0.5);
}

#[cfg(feature = "serde")]
mod pores {
    use super::direction;
    use crate::render::{Camera, Picture, View, rays::prepare, stage::Stage};
    use glam::Vec3;

    /// Rays that meet the mesh of a sponge, and those of them that pass the place where they do.
    fn through_pores(view: View) -> (usize, usize) {
        let scene = crate::scene::preset("dry").unwrap_or_else(|error| panic!("{error}"));
        let world = crate::World::new(&scene).unwrap_or_else(|error| panic!("{error}"));
        let picture = Picture {
            nodes: world.node_positions(),
            rest: &world.lattice().position,
            triangles: &world.lattice().triangles,
            view,
            ..Picture::default()
        };
        let camera = Camera::framing(Vec3::ZERO, Vec3::splat(0.08));
        let stage = Stage::new(&picture, &camera, 64, 36);
        let (setting, _) = prepare(&stage);
        let (mut met, mut passed) = (0, 0);
        for key in 0..4000 {
            let origin = Vec3::new(0.0, 0.04, 0.0) + direction(90_000 + 7 * key).normalize() * 0.2;
            let towards =
                (Vec3::new(0.0, 0.04, 0.0) + direction(20_000 + 5 * key) * 0.09 - origin).normalize();
            let Some(hit) = setting.tree.hit(origin, towards, f32::INFINITY) else { continue };
            met += 1;
            let nearest = setting.sponge_on(origin, towards, f32::INFINITY).map(|hit| hit.distance);
            passed += usize::from(nearest != Some(hit.distance));
        }
        (met, passed)
    }

    #[test]
    fn pores_cut_the_outline_of_a_sponge() {
        let (met, passed) = through_pores(View::Realistic);
        assert!(met > 2000 && passed > met / 1000 && passed < met / 20, "{passed} of {met}");
        // Negative control: a map of the saturation has no pores.
        let (met, passed) = through_pores(View::Saturation);
        assert!(met > 2000 && passed == 0, "{passed} of {met}");
    }
}
