//! Bricks of nodes that are all air, all water or neither: rays skip the first two.

use super::grid::Grid;
use crate::render::bands;

/// Cells along a side of a brick.
pub(super) const BRICK: usize = 4;
/// Longest skip, in bricks.
const LONGEST: u8 = 8;

#[cfg(feature = "gpu")]
shared_with_shaders!(BRICKS: BRICK, LONGEST);

/// What the nodes of a brick are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::render) enum Content {
    Air,
    Water,
    Surface,
}

/// All bricks of a grid.
#[derive(Debug)]
pub(super) struct Bricks {
    pub(super) sides: [usize; 3],
    content: Vec<Content>,
    /// Bricks to each side of a brick, itself included, that are as it is.
    skip: Vec<u8>,
}

impl Bricks {
    /// The bricks of values on a grid.
    pub(super) fn new(grid: &Grid, values: &[f32]) -> Self {
        let sides = grid.bricks();
        let content = bands::map(sides[2], |z| {
            let mut layer = Vec::with_capacity(sides[0] * sides[1]);
            for y in 0..sides[1] {
                layer.extend((0..sides[0]).map(|x| content(grid, values, [x, y, z])));
            }
            layer
        });
        let content: Vec<Content> = content.into_iter().flatten().collect();
        let skip = skips(&content, sides);
        Self { sides, content, skip }
    }

    /// Content of a brick, and how many bricks to each side, itself included, are as it is.
    pub(super) fn at(&self, [x, y, z]: [usize; 3]) -> (Content, u8) {
        let index = (z * self.sides[1] + y) * self.sides[0] + x;
        (self.content[index], self.skip[index])
    }
}

fn content(grid: &Grid, values: &[f32], [x, y, z]: [usize; 3]) -> Content {
    let range = |place: usize, nodes: usize| place * BRICK..(place * BRICK + BRICK + 1).min(nodes);
    let (mut least, mut most) = (f32::MAX, f32::MIN);
    for z in range(z, grid.sides[2]) {
        for y in range(y, grid.sides[1]) {
            let row = (z * grid.sides[1] + y) * grid.sides[0];
            for value in &values[row..row + grid.sides[0]][range(x, grid.sides[0])] {
                least = least.min(*value);
                most = most.max(*value);
            }
        }
    }
    if most < 0.0 {
        Content::Air
    } else if least > 0.0 {
        Content::Water
    } else {
        Content::Surface
    }
}

/// Half sides of the cubes of equal bricks around each brick.
fn skips(content: &[Content], sides: [usize; 3]) -> Vec<u8> {
    let mut skip = vec![1; content.len()];
    let index = |[x, y, z]: [usize; 3]| (z * sides[1] + y) * sides[0] + x;
    for level in 1..LONGEST {
        let before = skip.clone();
        let mut any = false;
        for z in 0..sides[2] {
            for y in 0..sides[1] {
                for x in 0..sides[0] {
                    let own = index([x, y, z]);
                    if content[own] == Content::Surface || before[own] != level {
                        continue;
                    }
                    let around = |place: usize, side: usize| place.saturating_sub(1)..(place + 2).min(side);
                    let same = around(z, sides[2]).all(|z| {
                        around(y, sides[1]).all(|y| {
                            around(x, sides[0]).all(|x| {
                                let other = index([x, y, z]);
                                content[other] == content[own] && before[other] >= level
                            })
                        })
                    });
                    if same {
                        skip[own] = level + 1;
                        any = true;
                    }
                }
            }
        }
        if !any {
            break;
        }
    }
    skip
}
