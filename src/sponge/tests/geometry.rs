use super::*;
use crate::sponge::{CLASS_FRAME, CLASS_OFFSET, COLORS};

/// Greatest distance of the local deformation gradient at rest from the frame of the class.
fn rest_error([p0, p1, p2, p3]: [DVec3; 4], edge: f64, class: usize) -> f64 {
    let gradient = [p1 - p0, p2 - p3, p2 + p3 - p0 - p1];
    let frame = CLASS_FRAME[class].map(|column| DVec3::from_array(column.map(f64::from)));
    let off = gradient.iter().zip(frame).map(|(column, axis)| (*column / edge - axis).abs().max_element());
    off.fold(0.0, f64::max)
}

fn tets_by_color(lattice: &Lattice) -> impl Iterator<Item = (usize, usize)> {
    (0..COLORS).flat_map(|color| {
        (lattice.color_start[color]..lattice.color_start[color + 1]).map(move |tet| (color, tet as usize))
    })
}

#[test]
fn the_class_table_is_the_published_one() {
    let published = [
        [[0, 0, 0], [1, 0, 0], [0, 0, -1], [0, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [0, -1, 0], [0, -1, -1]],
        [[0, 0, 0], [1, 0, 0], [0, 0, 0], [0, -1, 0]],
        [[0, 0, 0], [1, 0, 0], [0, -1, -1], [0, 0, -1]],
        [[0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 0]],
        [[0, 0, 0], [0, 1, 0], [0, 0, -1], [-1, 0, -1]],
        [[0, 0, 0], [0, 1, 0], [0, 0, 0], [0, 0, -1]],
        [[0, 0, 0], [0, 1, 0], [-1, 0, -1], [-1, 0, 0]],
        [[0, 0, 0], [0, 0, 1], [0, -1, 0], [0, 0, 0]],
        [[0, 0, 0], [0, 0, 1], [-1, 0, 0], [-1, -1, 0]],
        [[0, 0, 0], [0, 0, 1], [0, 0, 0], [-1, 0, 0]],
        [[0, 0, 0], [0, 0, 1], [-1, -1, 0], [0, -1, 0]],
    ];
    assert_eq!(CLASS_OFFSET, published);
}

#[test]
fn tets_are_congruent_and_positively_oriented() {
    for built in [cube(4), mixed()] {
        for (color, tet) in tets_by_color(&built) {
            let edge = f64::from(built.sponges[built.tet_sponge[tet] as usize].edge);
            let corners = corners(&built, built.tets[tet]);
            let ratio = volume(corners) / (edge.powi(3) / 12.0);
            assert!((ratio - 1.0).abs() < 1e-4, "tet {tet}: volume off by {ratio}");
            let error = rest_error(corners, edge, color / 2);
            assert!(error < 1e-4, "tet {tet}: rest matrix off by {error}");
            let [p0, p1, p2, p3] = corners;
            assert!(volume([p0, p1, p3, p2]) < 0.0, "the control must be inside out");
            assert!(rest_error([p0, p1, p3, p2], edge, color / 2) > 1.0);
        }
    }
}

#[test]
fn a_dyadic_edge_leaves_no_rounding() {
    let cube = cube(3);
    let edge = f64::from(EDGE);
    for (color, tet) in tets_by_color(&cube) {
        let corners = corners(&cube, cube.tets[tet]);
        assert_eq!(rest_error(corners, edge, color / 2), 0.0);
        assert_eq!(volume(corners), edge.powi(3) / 2.0 / 6.0);
    }
    // Only nodes without pits: those on the faces and below them have more.
    let exact = |node: usize| f64::from(cube.node_tet_count[node]) * edge.powi(3) / 48.0;
    for node in 0..cube.node_count() {
        let ratio = f64::from(cube.node_volume[node]) / exact(node);
        assert!(if cube.node_tet_count[node] == 24 { (ratio - 1.0).abs() < 1e-7 } else { ratio > 1.01 });
        assert_eq!(cube.position[node][3], 0.0);
    }
}

#[test]
fn frames_are_proper_rotations() {
    for frame in CLASS_FRAME {
        let [d, e, f] = frame.map(|column| DVec3::from_array(column.map(f64::from)));
        assert_eq!(d.cross(e), f);
        assert_eq!(d.dot(e), 0.0);
        assert_eq!([d, e, f].map(DVec3::length), [1.0; 3]);
    }
}

/// Number of tets that hold a point strictly inside.
fn holders(lattice: &Lattice, tets: &[[u32; 4]], point: DVec3) -> usize {
    let holds = |tet: &&[u32; 4]| {
        let whole = corners(lattice, **tet);
        (0..4).all(|slot| {
            let mut part = whole;
            part[slot] = point;
            volume(part) > 0.0
        })
    };
    tets.iter().filter(holds).count()
}

#[test]
fn tets_tile_the_block() {
    let n = 4;
    let cube = cube(n);
    // The pits of the surface are half an edge deep.
    let [low, high] = [0.5, f64::from(n) - 0.5].map(|cells| cells * f64::from(EDGE));
    let mut seed = 7;
    let mut point = || DVec3::from_array([0; 3].map(|_| low + (high - low) * random(&mut seed)));
    let points: Vec<DVec3> = (0..60).map(|_| point()).collect();
    for &point in &points {
        assert_eq!(holders(&cube, &cube.tets, point), 1, "at {point}");
    }

    let lost = cube.tets.iter().position(|tet| holders(&cube, &[*tet], points[0]) == 1).expect("found above");
    let mut holed = cube.tets.clone();
    holed.remove(lost);
    assert_eq!(holders(&cube, &holed, points[0]), 0, "the control has a hole");
    let mut doubled = cube.tets.clone();
    doubled.push(cube.tets[lost]);
    assert_eq!(holders(&cube, &doubled, points[0]), 2, "the control has an overlap");
}

#[test]
fn an_inner_cell_owns_its_own_volume() {
    // All tets whose first node is one inner A node: their volume is that of one cell.
    let cube = cube(4);
    let inner = (0..cube.vertex_color_start[2]).filter(|&node| cube.node_tet_count[node as usize] == 24);
    for node in inner {
        let own = cube.tets.iter().filter(|tet| tet[0] == node);
        let total: f64 = own.map(|&tet| volume(corners(&cube, tet))).sum();
        assert!((total / f64::from(EDGE).powi(3) - 1.0).abs() < 1e-14);
    }
}

/// Directed edges of triangles without their partner in the other direction, and the largest number of uses of an edge.
fn open_edges(triangles: &[[u32; 3]]) -> (usize, usize) {
    let edges = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut directed: Vec<[u32; 2]> = edges.collect();
    directed.sort_unstable();
    let count = |edge: [u32; 2]| {
        directed.partition_point(|&other| other <= edge) - directed.partition_point(|&other| other < edge)
    };
    let open = directed.iter().filter(|&&[a, b]| count([a, b]) != count([b, a])).count();
    let maximum = directed.iter().map(|&[a, b]| count([a, b]) + count([b, a])).max();
    (open, maximum.unwrap_or(0))
}

fn enclosed(lattice: &Lattice, triangles: &[[u32; 3]]) -> f64 {
    let cone = |&[a, b, c]: &[u32; 3]| {
        // Cones from a node of the mesh keep the products small.
        let apex = place(lattice, triangles[0][0]);
        let [a, b, c] = [a, b, c].map(|node| place(lattice, node) - apex);
        a.dot(b.cross(c)) / 6.0
    };
    triangles.iter().map(cone).sum()
}

#[test]
fn the_surface_is_closed_and_outward() {
    let cubes = [2, 3, 5].map(cube);
    for built in cubes.iter().chain([&mixed()]) {
        for (index, summary) in (0..).zip(&built.sponges) {
            let range = summary.triangles.start as usize..summary.triangles.end as usize;
            assert!(built.triangle_sponge[range.clone()].iter().all(|&sponge| sponge == index));
            let triangles = &built.triangles[range];
            let (open, maximum) = open_edges(triangles);
            assert_eq!(open, 0, "sponge {index} has open edges");
            if index == 1 || built.sponges.len() == 1 {
                assert_eq!(maximum, 2, "a block has two triangles at each edge");
            }
            let volume = enclosed(built, triangles);
            let tets = f64::from(summary.tet_count) * f64::from(summary.edge).powi(3) / 12.0;
            assert!((volume / tets - 1.0).abs() < 1e-5, "sponge {index} encloses {volume}");
            // An ellipsoid touches the faces of its box in a few squares.
            assert!(index == 0 && built.sponges.len() > 1 || tets < 0.95 * summary.rest_volume);

            assert!(open_edges(&triangles[1..]).0 > 0, "the control has a hole");
            let mut turned = triangles.to_vec();
            turned[0].swap(1, 2);
            assert!(open_edges(&turned).0 > 0, "the control has a triangle turned over");
        }
    }
}

#[test]
fn the_surface_holds_the_faces_used_once() {
    let built = mixed();
    let sorted = |mut face: [u32; 3]| {
        face.sort_unstable();
        face
    };
    let of_tet = |&[a, b, c, d]: &[u32; 4]| [[b, c, d], [a, d, c], [a, b, d], [a, c, b]].map(sorted);
    let mut faces: Vec<[u32; 3]> = built.tets.iter().flat_map(of_tet).collect();
    faces.sort_unstable();
    assert!(faces.chunk_by(|a, b| a == b).all(|same| same.len() <= 2));
    let once: Vec<[u32; 3]> =
        faces.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect();
    let mut surface: Vec<[u32; 3]> = built.triangles.iter().copied().map(sorted).collect();
    surface.sort_unstable();
    assert_eq!(surface, once);

    let mut on_surface = vec![false; built.node_count()];
    for node in once.iter().flatten() {
        on_surface[*node as usize] = true;
    }
    assert_eq!(built.node_surface, on_surface);
    let inside = (0..built.node_count()).filter(|&node| !on_surface[node]);
    assert!(inside.clone().count() > 0);
    assert!(inside.into_iter().all(|node| built.node_tet_count[node] == 24));
    // Round a node on the surface at least one tet is missing.
    assert!((0..built.node_count()).all(|node| on_surface[node] == (built.node_tet_count[node] < 24)));
}
