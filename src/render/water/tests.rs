//! The field against sums of the kernels, and against shapes that are known.

use super::*;

fn empty() -> Surface {
    Surface::new(&crate::render::Picture::default())
}

/// A block of particles on a lattice: counts along the axes, from a corner.
fn block(counts: [i32; 3], spacing: f32) -> Vec<Vec3> {
    let mut positions = Vec::new();
    for z in 0..counts[2] {
        for y in 0..counts[1] {
            for x in 0..counts[0] {
                positions.push((Vec3::new(x as f32, y as f32, z as f32) + 0.5) * spacing);
            }
        }
    }
    positions
}

fn made(positions: &[Vec3], container: Option<(Vec3, Vec3)>) -> (Field, Vec<Kernel>) {
    let (sponge, spacing) = (empty(), 0.01);
    let free = vec![1.0; positions.len()];
    let input = Input { positions, free: &free, spacing, container, sponge: &sponge, bodies: &[] };
    let Water { field, .. } = water(&input).expect("there is water");
    (field, kernels::kernels(positions, &free, spacing, &Walls { container }))
}

#[test]
fn nodes_have_the_sum_of_the_kernels_as_the_paper_evaluates_it() {
    let mut positions = block([6, 5, 7], 0.01);
    positions.push(Vec3::new(0.02, 0.12, 0.03));
    let (field, kernels) = made(&positions, None);
    let direct = |point: Vec3, kernels: &[Kernel]| {
        let sum: f32 = kernels.iter().map(|kernel| kernel.value(point - kernel.centre)).sum();
        sum.min(1.5) - density::LEVEL
    };
    let [nx, ny, nz] = field.grid.sides;
    let (mut worst, mut lost, mut seen) = (0.0_f32, 0.0_f32, 0);
    for index in (0..nx * ny * nz).step_by(5) {
        let point = field.grid.node(index % nx, index / nx % ny, index / nx / ny);
        let value = field.values[index];
        worst = worst.max((value - direct(point, &kernels)).abs());
        lost = lost.max((value - direct(point, &kernels[1..])).abs());
        seen += usize::from(value.abs() < 0.4);
    }
    assert!(seen > 100 && worst < 1e-4, "{seen} {worst}");
    // Negative control: a kernel less is seen.
    assert!(lost > 1e-2, "{lost}");
}

#[test]
fn a_drop_is_a_ball_and_a_pool_is_flat_up_to_its_walls() {
    let (field, _) = made(&[Vec3::splat(0.1)], None);
    let hit = field.march(Vec3::new(0.0, 0.1, 0.1), Vec3::X, (0.0, 1.0), false).expect("the drop");
    assert!((0.1 - hit - 0.0056).abs() < 5e-4, "{hit}");
    let container = (Vec3::ZERO, Vec3::new(0.2, 0.2, 0.2));
    let pool = block([20, 8, 20], 0.01);
    let heights = |container| {
        let (field, _) = made(&pool, container);
        let height =
            |x: f32| field.march(Vec3::new(x, 0.19, 0.1), Vec3::NEG_Y, (0.0, 0.2), false).map(|t| 0.19 - t);
        [0.001, 0.02, 0.1].map(|x| height(x).unwrap_or(0.0))
    };
    let [wall, near, middle] = heights(Some(container));
    assert!((middle - 0.08).abs() < 0.003 && (wall - middle).abs() < 5e-4, "{wall} {near} {middle}");
    // Negative control: without mirror images the water falls off towards the wall.
    let [wall, _, middle] = heights(None);
    assert!(middle - wall > 2e-3, "{wall} {middle}");
}

#[test]
fn rays_leave_water_where_they_enter_it_from_the_other_side() {
    let (field, _) = made(&block([8, 8, 8], 0.01), None);
    for (origin, direction) in [
        (Vec3::new(-0.1, 0.03, 0.05), Vec3::X),
        (Vec3::new(0.2, 0.21, 0.19), Vec3::new(-0.6, -0.6, -0.52).normalize()),
    ] {
        let enter = field.march(origin, direction, (0.0, 1.0), false).expect("it enters");
        let leave = field.march(origin, direction, (enter + 1e-3, 1.0), true).expect("it leaves");
        let back = origin + direction;
        let other = field.march(back, -direction, (0.0, 1.0), false).expect("it enters");
        assert!(leave > enter + 0.05 && (1.0 - other - leave).abs() < 1e-4, "{enter} {leave} {other}");
        assert!(field.value(origin + direction * enter).abs() < 2e-3);
        assert!(field.normal(origin + direction * enter).dot(direction) < -0.5);
    }
    assert!(field.march(Vec3::new(-0.1, 0.3, 0.05), Vec3::X, (0.0, 1.0), false).is_none());
}

/// The upper face of a sponge at a height of 0, from corner to corner of `side` times `side` facets of 0.01 m.
fn face(side: u32) -> Surface {
    let row = side + 1;
    let nodes: Vec<[f32; 4]> = (0..row * row)
        .map(|node| [(node % row) as f32 * 0.01, 0.0, (node / row) as f32 * 0.01, 0.0])
        .collect();
    let corners = (0..side * side).flat_map(|facet| {
        let first = facet / side * row + facet % side;
        let [a, b, c, d] = [first, first + 1, first + row, first + row + 1];
        [[a, c, b], [b, c, d]]
    });
    let triangles: Vec<[u32; 3]> = corners.collect();
    Surface::new(&crate::render::Picture { nodes: &nodes, triangles: &triangles, ..Default::default() })
}

#[test]
fn a_film_on_a_sponge_covers_it_and_has_no_surface() {
    let (bare, sponge) = (empty(), face(16));
    assert!(sponge.normals[8 * 17 + 8].y > 0.99);
    let height = |layers: i32, sponge: &Surface| {
        let positions = block([16, layers, 16], 0.01);
        let free = vec![1.0; positions.len()];
        let input =
            Input { positions: &positions, free: &free, spacing: 0.01, container: None, sponge, bodies: &[] };
        let Water { field, films, .. } = water(&input).expect("there is water");
        let start = Vec3::new(0.081, 0.09, 0.083);
        let height = field.march(start, Vec3::NEG_Y, (0.0, 0.09), false).map(|way| 0.09 - way);
        (height, films.get(8 * 17 + 8).copied())
    };
    let (film, cover) = height(1, &sponge);
    assert!(film.is_none() && cover.is_some_and(|cover| cover > 0.9), "{film:?} {cover:?}");
    let (deep, _) = height(5, &sponge);
    assert!(deep.is_some_and(|deep| (deep - 0.05).abs() < 0.005), "{deep:?}");
    let (between, _) = height(2, &sponge);
    assert!(between.is_some_and(|between| between > 0.005 && between < 0.02), "{between:?}");
    // Negative control: the same layer has a surface where no sponge is.
    let (layer, _) = height(1, &bare);
    assert!(layer.is_some_and(|layer| layer > 0.005), "{layer:?}");
}

#[test]
fn particles_at_a_sponge_are_water_of_its_pores_whatever_share_of_them_it_holds() {
    let (bare, sponge) = (empty(), face(16));
    let positions = [0.0, 0.001, 0.012].map(|height| Vec3::new(0.08, height, 0.08));
    let share = |interior: f32, sponge: &Surface| free(&positions, &[interior; 3], sponge, 0.01);
    // As at an edge: less than at a face.
    let [inside, near, apart] = share(0.3, &sponge)[..] else { panic!("three particles") };
    assert!(inside == 0.0 && near == 0.0 && apart == 1.0, "{inside} {near} {apart}");
    assert!(share(0.9, &sponge).iter().all(|free| *free == 0.0));
    // Negative control: the share alone calls them free water.
    assert!(share(0.3, &bare).iter().all(|free| *free == 1.0));
}
