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
