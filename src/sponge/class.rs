//! The twelve classes of tets, with their offsets, frames and colours of slots.

/// Number of classes: three directions of the A edge, two of the gap to the B edge, two signs.
pub const TET_CLASS_COUNT: usize = 12;

/// Colours of tets are class times parity of the cell, the minimum, since 24 tets meet in a node. Vertex colours are A even, A
/// odd, B even, B odd.
pub use sorb_kernels::pbd::lattice::{COLORS, VERTEX_COLORS};

const _: () = assert!(COLORS == 2 * TET_CLASS_COUNT, "a colour for each class and parity");

/// Local frame of each class: columns `d`, `o e`, `s f` of a proper rotation, entries 0 and +-1.
///
/// `d` is the axis of the A edge. `s f` points from the middle of the A edge to the middle of the B edge. `o e` runs along the B edge. The
/// order is `CLASS_FRAME[class][column][axis]`. It turns a local deformation gradient into a global one, `F = [f_d f_e f_f] P^T`. Only
/// anisotropic materials and the output of stress need it.
pub const CLASS_FRAME: [[[i32; 3]; 3]; TET_CLASS_COUNT] = class_frames();

/// Index offsets from the cell of a tet to its nodes: `CLASS_OFFSET[class][slot][axis]`.
///
/// Slots 0 and 1 are nodes of sublattice A, slots 2 and 3 of sublattice B. With the frame of the class
/// `p1 - p0 = a d`, `p2 - p3 = a o e` and `p2 + p3 - p0 - p1 = a s f`, where `a` is the edge.
pub const CLASS_OFFSET: [[[i32; 3]; 4]; TET_CLASS_COUNT] = class_offsets();

/// Vertex colour held by each slot of the tets of a colour: `SLOT_VERTEX_COLOR[color][slot]`.
///
/// For a cell of parity `q`, slot 0 is A of parity `q` and slot 1 is A of the other parity. Of slots 2 and 3 the one with an
/// even sum of offsets is B of parity `q`. The other one is B of the other parity.
pub const SLOT_VERTEX_COLOR: [[u8; 4]; COLORS] = slot_vertex_colors();

/// Slot that holds a vertex colour: `VERTEX_COLOR_SLOT[color][vertex_color]`, the inverse of
/// [`SLOT_VERTEX_COLOR`].
pub const VERTEX_COLOR_SLOT: [[u8; 4]; COLORS] = vertex_color_slots();

const fn class_frames() -> [[[i32; 3]; 3]; TET_CLASS_COUNT] {
    let mut frames = [[[0; 3]; 3]; TET_CLASS_COUNT];
    let mut class = 0;
    while class < TET_CLASS_COUNT {
        let d = class / 4;
        let f = (d + 1 + (class / 2) % 2) % 3;
        let e = 3 - d - f;
        let sign = if class % 2 == 0 { 1 } else { -1 };
        // The sign of the permutation (d, e, f) makes the frame, and with it the tet, right-handed.
        let orientation = if (d + 1) % 3 == e { sign } else { -sign };
        frames[class][0][d] = 1;
        frames[class][1][e] = orientation;
        frames[class][2][f] = sign;
        class += 1;
    }
    frames
}

const fn class_offsets() -> [[[i32; 3]; 4]; TET_CLASS_COUNT] {
    let frames = class_frames();
    let mut offsets = [[[0; 3]; 4]; TET_CLASS_COUNT];
    let mut class = 0;
    while class < TET_CLASS_COUNT {
        let [along_a, along_b, gap] = frames[class];
        let mut axis = 0;
        while axis < 3 {
            // In units of a/2, where A(i,j,k) sits at (2i,2j,2k) and B(i,j,k) at (2i+1,2j+1,2k+1).
            let middle = along_a[axis] + gap[axis];
            offsets[class][1][axis] = along_a[axis];
            offsets[class][2][axis] = (middle + along_b[axis] - 1) / 2;
            offsets[class][3][axis] = (middle - along_b[axis] - 1) / 2;
            axis += 1;
        }
        class += 1;
    }
    offsets
}

const fn slot_vertex_colors() -> [[u8; 4]; COLORS] {
    let offsets = class_offsets();
    let mut colors = [[0; 4]; COLORS];
    let mut color = 0;
    while color < COLORS {
        let mut slot = 0;
        while slot < 4 {
            let offset = offsets[color / 2][slot];
            let odd_offset = (offset[0] + offset[1] + offset[2]) % 2 != 0;
            let odd_cell = color % 2 == 1;
            let sublattice_b = slot >= 2;
            colors[color][slot] = 2 * sublattice_b as u8 + (odd_offset != odd_cell) as u8;
            slot += 1;
        }
        color += 1;
    }
    colors
}

const fn vertex_color_slots() -> [[u8; 4]; COLORS] {
    let colors = slot_vertex_colors();
    let mut slots = [[0; 4]; COLORS];
    let mut color = 0;
    while color < COLORS {
        let mut slot = 0;
        while slot < 4 {
            slots[color][colors[color][slot as usize] as usize] = slot;
            slot += 1;
        }
        color += 1;
    }
    slots
}

/// Coordinates of the four nodes of a tet of cell (0,0,0) in units of half an edge.
pub(super) fn doubled(class: usize) -> [[i32; 3]; 4] {
    std::array::from_fn(|slot| {
        let shift = i32::from(slot >= 2);
        CLASS_OFFSET[class][slot].map(|offset| 2 * offset + shift)
    })
}
