use super::*;
use crate::sponge::{COLORS, pieces};

/// Tets of a block: four for each square between two cells.
fn tets_of_block([x, y, z]: [u32; 3]) -> u32 {
    4 * ((x - 1) * y * z + x * (y - 1) * z + x * y * (z - 1))
}

/// Triangles of a block: two for each A edge that lies in a face of the box but not on its rim.
fn triangles_of_block([x, y, z]: [u32; 3]) -> u32 {
    let face = |a: u32, b: u32| 2 * (a * (b - 1) + b * (a - 1));
    2 * (face(x, y) + face(y, z) + face(z, x))
}

#[test]
fn cubes_have_the_exact_counts() {
    for n in 2..=6 {
        let cube = cube(n);
        let count = |rows: usize| u32::try_from(rows).expect("small");
        assert_eq!(count(cube.tet_count()), 12 * n * n * n - 12 * n * n, "tets of {n}^3");
        assert_eq!(count(cube.node_count()), (n + 1).pow(3) + n.pow(3) - 8, "nodes of {n}^3");
        assert_eq!(count(cube.triangles.len()), 24 * n * n - 24 * n, "triangles of {n}^3");
        let side = f64::from(n) * f64::from(EDGE);
        let wanted = side.powi(3);
        let volume = cube.rest_volume(0).expect("one sponge");
        assert!((volume / wanted - 1.0).abs() < 1e-14, "volume of {n}^3: {volume} and not {wanted}");
    }
}

#[test]
fn eight_cubed_has_the_published_counts() {
    let cube = cube(8);
    assert_eq!((cube.tet_count(), cube.node_count(), cube.triangles.len()), (5376, 1233, 1344));
    assert_eq!(cube.sponges[0].node_count, 1233);
    assert_eq!(cube.sponges[0].tet_count, 5376);
    assert_eq!(cube.sponges[0].triangles, 0..1344);
}

#[test]
fn uneven_blocks_have_the_exact_counts() {
    for cells in [[1, 1, 2], [2, 1, 1], [1, 5, 3], [2, 3, 4], [7, 2, 3], [1, 1, 9]] {
        let built = lattice(&[sponge(cells, &block)]);
        assert_eq!(built.tet_count(), tets_of_block(cells) as usize, "tets of {cells:?}");
        assert_eq!(built.triangles.len(), triangles_of_block(cells) as usize, "triangles of {cells:?}");
    }
}

#[test]
fn inner_nodes_have_24_tets_and_inner_cells_12() {
    let n = 5;
    let cube = cube(n);
    let side = f64::from(n) * f64::from(EDGE);
    let mut inner = 0;
    for node in 0..cube.node_count() {
        let here = place(&cube, u32::try_from(node).expect("small"));
        // Nodes of A on the faces and nodes of B next to them miss tets.
        let deep =
            here.min_element() > 0.6 * f64::from(EDGE) && (side - here).min_element() > 0.6 * f64::from(EDGE);
        assert_eq!(deep, cube.node_tet_count[node] == 24, "node at {here}");
        assert!((1..=24).contains(&cube.node_tet_count[node]));
        inner += usize::from(deep);
    }
    assert_eq!(inner, 4_usize.pow(3) + 3_usize.pow(3));

    // A tet belongs to the cell of its first node, which an A node away from the faces names.
    let mut of_cell = vec![0; cube.node_count()];
    for tet in &cube.tets {
        of_cell[tet[0] as usize] += 1;
    }
    let [first_b, end] = [cube.vertex_color_start[2], cube.vertex_color_start[4]];
    assert!(of_cell[first_b as usize..end as usize].iter().all(|&count| count == 0));
    for (node, &count) in of_cell[..first_b as usize].iter().enumerate() {
        assert_eq!(cube.node_tet_count[node] == 24, count == 12, "cell of node {node}");
    }
}

#[test]
fn node_volumes_sum_to_the_volume_of_the_tets() {
    let mixed = mixed();
    for (index, summary) in (0..).zip(&mixed.sponges) {
        let owned = |&node: &usize| mixed.node_sponge[node] == index;
        let nodes = (0..mixed.node_count()).filter(owned);
        let sum: f64 = nodes.clone().map(|node| f64::from(mixed.node_volume[node])).sum();
        assert!((sum / summary.rest_volume - 1.0).abs() < 1e-7, "sponge {index}");
        assert_eq!(nodes.clone().count(), summary.node_count as usize);
        let corners: u32 = nodes.map(|node| mixed.node_tet_count[node]).sum();
        assert_eq!(corners, 4 * summary.tet_count);
        let tets = (0..COLORS).map(|color| mixed.tet_range(color, index).len()).sum::<usize>();
        assert_eq!(tets, summary.tet_count as usize);
        let by_color = (0..4).map(|color| mixed.node_range(color, index).len()).sum::<usize>();
        assert_eq!(by_color, summary.node_count as usize);
    }
    assert!(mixed.node_tet_count.iter().all(|&count| count > 0), "only nodes with tets are rows");
    assert_eq!(mixed.rest_volume(3), None);
    assert!(mixed.tet_range(0, 3).is_empty() && mixed.node_range(4, 0).is_empty());
}

#[test]
fn no_sponges_give_an_empty_lattice() {
    assert_eq!(lattice(&[]), Lattice::default());
}

#[test]
fn pieces_count_what_hangs_together() {
    assert_eq!(pieces(&mixed()).piece_count, [1, 1, 1]);
    let gap = |centroid: Vec3| (centroid.x - 0.5).abs() > 0.2;
    let cut = lattice(&[sponge([10, 4, 4], &gap), sponge([3, 3, 3], &block)]);
    let found = pieces(&cut);
    assert_eq!(found.piece_count, [2, 1]);
    for (node, &piece) in found.node_piece.iter().enumerate() {
        let here = cut.position[node];
        let wanted = if cut.node_sponge[node] == 1 { 2 } else { u32::from(here[0] > 5.0 * EDGE) };
        assert_eq!(piece, wanted, "node at {here:?}");
    }
}
