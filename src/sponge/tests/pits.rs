//! Additional volume of tets and nodes by pits.

use super::*;
use crate::sponge::{Axis, cylinder};

const SIZES: [[u32; 3]; 12] = [
    [2, 2, 2],
    [3, 3, 3],
    [5, 5, 5],
    [8, 8, 8],
    [1, 1, 2],
    [1, 1, 9],
    [7, 1, 1],
    [1, 6, 4],
    [9, 5, 1],
    [2, 2, 1],
    [2, 3, 4],
    [1, 5, 3],
];

/// Volume of the box of a block over that of a cell.
fn cells([x, y, z]: [u32; 3]) -> f64 {
    f64::from(x * y * z)
}

/// Sums of the weights and of the volumes of the nodes, over the volume of a tet and of a cell.
fn sums(built: &Lattice) -> (f64, f64) {
    let weights: f64 = built.tet_weight.iter().map(|weight| f64::from(*weight)).sum();
    let volumes: f64 = built.node_volume.iter().map(|volume| f64::from(*volume)).sum();
    (weights, volumes / f64::from(EDGE).powi(3))
}

#[test]
fn a_block_is_as_large_as_its_box() {
    for size in SIZES {
        let built = lattice(&[sponge(size, &block)]);
        let volume = built.rest_volume(0).expect("one sponge") / f64::from(EDGE).powi(3);
        assert!((volume / cells(size) - 1.0).abs() < 1e-14, "{size:?}: {volume}");
        let (weights, volumes) = sums(&built);
        assert!((weights / 12.0 / cells(size) - 1.0).abs() < 1e-7, "weights of {size:?}: {weights}");
        assert!((volumes / cells(size) - 1.0).abs() < 1e-7, "nodes of {size:?}: {volumes}");
        // Negative controls: the tets alone, and one pit too few.
        assert!(built.tet_count() as f64 / 12.0 / cells(size) < 0.9);
        assert!(((weights - 2.0) / 12.0 / cells(size) - 1.0).abs() > 1e-5);
    }
}

#[test]
fn the_centre_of_the_nodes_is_that_of_the_box_and_their_inertia_near_it() {
    let second = |built: &Lattice, size: [u32; 3], axis: usize, volume: &dyn Fn(usize) -> f64| {
        let middle = 0.5 * f64::from(size[axis]) * f64::from(EDGE);
        let nodes = 0..built.node_count();
        let arm = |node: usize| f64::from(built.position[node][axis]) - middle;
        let (first, second) = nodes.fold((0.0, 0.0), |(first, second), node| {
            let (volume, arm) = (volume(node), arm(node));
            (first + volume * arm, second + volume * arm * arm)
        });
        let exact = cells(size) * f64::from(EDGE).powi(3) * (2.0 * middle).powi(2) / 12.0;
        (first / (exact / middle), second / exact - 1.0)
    };
    for size in [[8, 8, 8], [6, 4, 5]] {
        let built = lattice(&[sponge(size, &block)]);
        for axis in 0..3 {
            let (first, error) = second(&built, size, axis, &|node| f64::from(built.node_volume[node]));
            assert!(first.abs() < 1e-6, "{size:?} along {axis}: centre off by {first}");
            let n = f64::from(size[axis]);
            assert!(error.abs() < 1.0 / (n * n), "{size:?} along {axis}: inertia off by {error}");
            // Negative control: tets alone have far too little.
            let of_tets =
                |node: usize| f64::from(built.node_tet_count[node]) * f64::from(EDGE).powi(3) / 48.0;
            assert!(second(&built, size, axis, &of_tets).1 < -0.5 / n);
        }
    }
}

#[test]
fn weights_are_one_inside_two_in_faces_and_more_at_edges() {
    let built = cube(6);
    let side = 6.0 * f64::from(EDGE);
    let depth = |tet: usize| {
        let middle = corners(&built, built.tets[tet]).iter().copied().sum::<DVec3>() / 4.0;
        let mut depths = middle.min(side - middle).to_array().map(|depth| depth / f64::from(EDGE));
        depths.sort_unstable_by(f64::total_cmp);
        depths
    };
    let mut seen = [0; 3];
    for tet in 0..built.tet_count() {
        let (weight, [minimum, next, _]) = (built.tet_weight[tet], depth(tet));
        if minimum > 0.3 {
            assert_eq!(weight, 1.0);
            seen[0] += 1;
        } else if next > 1.1 {
            assert_eq!(weight, 2.0);
            seen[1] += 1;
        } else {
            assert!(weight > 2.0 && weight <= 3.0, "{weight} at {minimum} and {next}");
            seen[2] += 1;
        }
    }
    assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
}

#[test]
fn a_mask_ends_without_pits_and_its_flat_ends_have_theirs() {
    // A half of a block whose mask ends it in a plane of A nodes: tets whose centroids lie in the plane are not cut.
    let half = |centroid: Vec3| centroid.x < 0.5 + 1e-3;
    let built = lattice(&[sponge([8, 4, 4], &half)]);
    let (weights, volumes) = sums(&built);
    assert!((weights / 12.0 - volumes).abs() < 1e-5);
    for (tet, weight) in built.tet_weight.iter().enumerate() {
        let at_end = corners(&built, built.tets[tet]).iter().all(|node| node.x > 3.4 * f64::from(EDGE));
        let middle = corners(&built, built.tets[tet]).iter().copied().sum::<DVec3>() / 4.0 / f64::from(EDGE);
        let inner = middle.y.min(middle.z).min(4.0 - middle.y).min(4.0 - middle.z) > 0.3;
        assert!(!(at_end && inner) || *weight == 1.0, "{weight} at {middle}");
    }
    // All the pits are in the ends, where the circle is.
    let built = lattice(&[sponge([12, 12, 5], &cylinder(Axis::Z))]);
    let mut at_ends = 0;
    for (tet, weight) in built.tet_weight.iter().enumerate() {
        let z =
            corners(&built, built.tets[tet]).iter().map(|node| node.z).sum::<f64>() / 4.0 / f64::from(EDGE);
        let from_middle =
            corners(&built, built.tets[tet]).iter().copied().sum::<DVec3>() / 4.0 / f64::from(EDGE) - 6.0;
        if from_middle.truncate().length() < 4.5 {
            let expected = if z.min(5.0 - z) < 0.3 { 2.0 } else { 1.0 };
            assert_eq!(*weight, expected);
            at_ends += usize::from(expected == 2.0);
        }
    }
    assert!(at_ends > 100);
}

#[test]
fn a_sponge_around_a_body_is_as_large_as_what_the_body_leaves() {
    // A body that occupies the half of a block beyond a plane of A nodes, or of B nodes.
    for (plane, size) in [(4.0, 4.0 * 16.0), (3.5, 3.5 * 16.0)] {
        let has_room = move |place: Vec3| 8.0 * place.x <= plane + 1e-3;
        let room = &has_room as &dyn Fn(Vec3) -> bool;
        let built = lattice(&[LatticeSponge { has_room: room, ..sponge([8, 4, 4], &block) }]);
        let (weights, volumes) = sums(&built);
        assert!((weights / 12.0 - volumes).abs() < 1e-5);
        assert!((volumes / size - 1.0).abs() < 0.02, "{plane}: {volumes} and not {size}");
        // Negative control: the tets alone.
        assert!(built.tet_count() as f64 / 12.0 / size < 0.8);
    }
}

#[test]
fn every_node_and_tet_has_its_share_whatever_the_shape() {
    for built in [mixed(), lattice(&[sponge([5, 5, 5], &|at| at.x + at.y < 0.9)])] {
        for (index, summary) in (0..).zip(&built.sponges) {
            let tet = f64::from(summary.edge).powi(3) / 12.0;
            let own = built.tet_weight.iter().zip(&built.tet_sponge).filter(|(_, sponge)| **sponge == index);
            let weights: f64 = own.map(|(weight, _)| f64::from(*weight)).sum();
            assert!((weights * tet / summary.rest_volume - 1.0).abs() < 1e-6, "sponge {index}");
        }
        assert!(built.tet_weight.iter().all(|weight| (1.0..8.0).contains(weight)));
    }
}

/// Sum of the gradients of a node's shape functions over the volume that its tets stand for, over the square of an edge. It is the force of
/// a uniform stress on it.
fn pull(built: &Lattice, weight: impl Fn(usize) -> f64) -> Vec<DVec3> {
    let mut pulls = vec![DVec3::ZERO; built.node_count()];
    for (index, &tet) in built.tets.iter().enumerate() {
        let corners = corners(built, tet);
        for slot in 0..4 {
            let [a, b, c] = [1, 2, 3].map(|next| corners[(slot + next) % 4]);
            let area = (b - a).cross(c - a) * 0.5;
            let inwards = if area.dot(corners[slot] - a) > 0.0 { area } else { -area };
            pulls[tet[slot] as usize] += inwards * (weight(index) / 3.0 / f64::from(EDGE).powi(2));
        }
    }
    pulls
}

#[test]
fn uniform_stress_leaves_all_in_balance_below_the_faces() {
    let built = cube(6);
    let weighed = pull(&built, |tet| f64::from(built.tet_weight[tet]));
    let plain = pull(&built, |_| 1.0);
    let (mut inside, mut below) = (0, 0);
    for (node, (weighed, plain)) in (0..).zip(weighed.iter().zip(&plain)) {
        let place = place(&built, node) / f64::from(EDGE);
        let mut depths = place.min(6.0 - place).to_array();
        depths.sort_unstable_by(f64::total_cmp);
        if depths[0] > 0.6 {
            assert!(weighed.length() < 1e-6, "{weighed} at {place}");
            inside += 1;
        } else if depths[0] > 0.4 && depths[1] > 1.6 {
            assert!(weighed.length() < 1e-6, "{weighed} at {place}");
            // Negative control: without pits the force is incomplete.
            assert!(plain.length() > 0.3, "{plain} at {place}");
            below += 1;
        } else if depths[0] < 0.1 && depths[1] > 1.6 {
            // A face takes its whole load, all of it at its own nodes.
            assert!((weighed.length() - 1.0).abs() < 1e-6, "{weighed} at {place}");
            assert!(plain.length() < 0.7);
        }
    }
    assert!(inside > 100 && below > 10, "{inside} {below}");
}
