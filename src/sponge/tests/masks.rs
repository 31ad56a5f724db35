use super::*;
use crate::sponge::{Axis, cylinder, ellipsoid};

/// Whether the tets are symmetric about the middle plane of the block across an axis.
fn symmetric(lattice: &Lattice, cells: [u32; 3], axis: usize) -> bool {
    let centroids = |mirrored: bool| {
        let mut all: Vec<[i64; 3]> = Vec::new();
        for &tet in &lattice.tets {
            let sum = corners(lattice, tet).iter().copied().sum::<DVec3>() * 2.0 / f64::from(EDGE);
            // Sums of node coordinates in half edges are whole numbers.
            #[expect(clippy::cast_possible_truncation, reason = "a small whole number")]
            let mut key = sum.to_array().map(|value| value as i64);
            if mirrored {
                key[axis] = 8 * i64::from(cells[axis]) - key[axis];
            }
            all.push(key);
        }
        all.sort_unstable();
        all
    };
    centroids(false) == centroids(true)
}

#[test]
fn shapes_are_as_symmetric_as_the_lattice() {
    for n in [3, 5, 6, 10] {
        for (axis, cells) in
            [[n; 3], [n, 4, 3]].into_iter().flat_map(|cells| (0..3).map(move |axis| (axis, cells)))
        {
            for keep in [&ellipsoid as &dyn Fn(Vec3) -> bool, &cylinder(Axis::Z), &block] {
                assert!(symmetric(&lattice(&[sponge(cells, keep)]), cells, axis), "{cells:?} across {axis}");
            }
        }
    }
    let lopsided = |centroid: Vec3| centroid.x < 0.6;
    assert!(!symmetric(&lattice(&[sponge([5; 3], &lopsided)]), [5; 3], 0), "the control is lopsided");
}

#[test]
fn shapes_approach_their_volume() {
    let cells = [16, 12, 14];
    let share = |keep: &dyn Fn(Vec3) -> bool| {
        let built = lattice(&[sponge(cells, keep)]);
        let box_volume = cells.iter().map(|&n| f64::from(n) * f64::from(EDGE)).product::<f64>();
        built.sponges[0].rest_volume / box_volume
    };
    let sphere = std::f64::consts::PI / 6.0;
    assert!((share(&ellipsoid) / sphere - 1.0).abs() < 0.02);
    let wanted = std::f64::consts::PI / 4.0;
    for axis in [Axis::X, Axis::Y, Axis::Z] {
        let found = share(&cylinder(axis));
        assert!((found / wanted - 1.0).abs() < 0.02, "{axis:?}: {found} and not {wanted}");
    }
}

#[test]
fn a_mask_is_asked_once_for_each_tet_and_half_in_the_unit_cube() {
    let asked = std::cell::RefCell::new(Vec::new());
    let keep = |centroid: Vec3| {
        asked.borrow_mut().push(centroid);
        true
    };
    let cells = [4, 2, 8];
    let built = lattice(&[LatticeSponge { origin: Vec3::new(3.0, -1.0, 2.0), ..sponge(cells, &keep) }]);
    let asked = asked.into_inner();
    let halves = 4 * 2 * (4 * 2 + 2 * 8 + 4 * 8);
    assert_eq!(asked.len(), built.tet_count() + halves);
    let inside = |centroid: &Vec3| centroid.min_element() > 0.0 && centroid.max_element() < 1.0;
    assert!(asked.iter().all(inside));
    let mean = asked.iter().sum::<Vec3>() / (544 + halves) as f32;
    assert_eq!(built.tet_count(), 4 * (3 * 2 * 8 + 4 * 8 + 4 * 2 * 7));
    assert!((mean - 0.5).abs().max_element() < 1e-3, "mean centroid {mean}");
}
