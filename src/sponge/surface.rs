//! The outer surface: faces of tets without a tet behind them.

use super::class::{TET_CLASS_COUNT, doubled};
use super::grid::{Grid, classes};

/// Slots of the face opposite to each slot, wound outwards for a positively oriented tet.
const FACE: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

/// The tet behind a face: its class and the offset of its cell.
#[derive(Clone, Copy)]
struct Behind {
    class: usize,
    offset: [i64; 3],
}

/// Tets behind the four faces of each class.
pub(super) struct Surface {
    behind: [[Behind; 4]; TET_CLASS_COUNT],
}

impl Surface {
    pub(super) fn new() -> Self {
        Self { behind: std::array::from_fn(|class| std::array::from_fn(|face| behind(class, face))) }
    }

    /// Cell and class of the tet behind the face opposite to a slot.
    pub(super) fn behind(&self, cell: [i64; 3], class: usize, slot: usize) -> ([i64; 3], usize) {
        let behind = self.behind[class][slot];
        (std::array::from_fn(|axis| cell[axis] + behind.offset[axis]), behind.class)
    }

    /// Calls `triangle` for each face of the outer surface, in the order of cells (k, j, i), classes and faces.
    pub(super) fn triangles(&self, grid: &Grid, mut triangle: impl FnMut([u32; 3])) {
        let [nx, ny, nz] = grid.cells;
        let deltas = grid.deltas();
        for k in 0..=nz {
            for j in 0..=ny {
                for i in 0..=nx {
                    let bases = grid.bases([i, j, k]);
                    let cell = [i, j, k].map(i64::from);
                    for class in classes(grid.present(bases[0])) {
                        for (slot, face) in FACE.iter().enumerate() {
                            let (other, behind) = self.behind(cell, class, slot);
                            if !grid.has(other, behind) {
                                let nodes = grid.nodes(bases, &deltas[class]);
                                triangle(face.map(|slot| nodes[slot]));
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Searches the cells around for the other tet with the three nodes of a face.
fn behind(class: usize, face: usize) -> Behind {
    let nodes = doubled(class);
    let wanted = FACE[face].map(|slot| nodes[slot]);
    for other in 0..TET_CLASS_COUNT {
        for place in 0..27 {
            let offset: [i32; 3] = [place % 3 - 1, place / 3 % 3 - 1, place / 9 - 1];
            let candidate = doubled(other)
                .map(|node| -> [i32; 3] { std::array::from_fn(|axis| node[axis] + 2 * offset[axis]) });
            let shares_face = wanted.iter().all(|node| candidate.contains(node));
            if shares_face && !candidate.contains(&nodes[face]) {
                return Behind { class: other, offset: offset.map(i64::from) };
            }
        }
    }
    unreachable!("the tets fill space, so each face has a tet on its other side")
}
