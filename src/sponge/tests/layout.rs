use super::*;
use crate::sponge::{COLORS, SLOT_VERTEX_COLOR, VERTEX_COLOR_SLOT};

fn vertex_color(lattice: &Lattice, node: u32) -> Option<usize> {
    let starts = &lattice.vertex_color_start;
    (0..4).find(|&color| (starts[color]..starts[color + 1]).contains(&node))
}

/// Colour and node of the first clash: two tets of one colour that share a node.
fn clash(tets: &[[u32; 4]], color_start: &[u32], nodes: usize) -> Option<(usize, u32)> {
    let mut last_color = vec![usize::MAX; nodes];
    for color in 0..COLORS {
        for tet in &tets[color_start[color] as usize..color_start[color + 1] as usize] {
            for &node in tet {
                if std::mem::replace(&mut last_color[node as usize], color) == color {
                    return Some((color, node));
                }
            }
        }
    }
    None
}

/// First tet whose slots break the rule: the vertex colour of a slot, or rising nodes in a slot.
fn disorder(lattice: &Lattice, tets: &[[u32; 4]]) -> Option<usize> {
    for (color, slots) in SLOT_VERTEX_COLOR.iter().enumerate() {
        let range = lattice.color_start[color] as usize..lattice.color_start[color + 1] as usize;
        for tet in range.clone() {
            let fits = |slot: usize| {
                let wanted = usize::from(slots[slot]);
                vertex_color(lattice, tets[tet][slot]) == Some(wanted)
                    && (tet == range.start || tets[tet - 1][slot] < tets[tet][slot])
            };
            if !(0..4).all(fits) {
                return Some(tet);
            }
        }
    }
    None
}

fn samples() -> Vec<Lattice> {
    let mut samples: Vec<Lattice> = (2..=5).map(cube).collect();
    samples.push(mixed());
    samples.push(lattice(&[sponge([1, 1, 7], &block), sponge([8, 1, 2], &block)]));
    samples
}

#[test]
fn the_24_colors_share_no_nodes() {
    for built in samples() {
        assert_eq!(clash(&built.tets, &built.color_start, built.node_count()), None);
    }

    let cube = cube(4);
    let mut swapped = cube.tets.clone();
    let inner = |tet: &[u32; 4]| tet.iter().all(|&node| cube.node_tet_count[node as usize] == 24);
    let [first, second] = [0, 1].map(|color| {
        let [start, end] = [color, color + 1].map(|color: usize| cube.color_start[color] as usize);
        start + cube.tets[start..end].iter().position(inner).expect("a cube of four cells has inner tets")
    });
    swapped.swap(first, second);
    assert!(clash(&swapped, &cube.color_start, cube.node_count()).is_some(), "the control must clash");
}

#[test]
fn each_slot_has_one_vertex_color_and_rising_nodes() {
    for built in samples() {
        assert_eq!(disorder(&built, &built.tets), None);
    }

    let cube = cube(4);
    let mut slots = cube.tets.clone();
    slots[100].swap(0, 1);
    assert_eq!(disorder(&cube, &slots), Some(100), "the control has two slots exchanged");
    let mut order = cube.tets.clone();
    let start = cube.color_start[5] as usize;
    order.swap(start, start + 1);
    assert_eq!(disorder(&cube, &order), Some(start + 1), "the control has two tets exchanged");
}

#[test]
fn slots_follow_the_documented_rule() {
    for (color, slots) in SLOT_VERTEX_COLOR.iter().enumerate() {
        let parity = color % 2;
        assert_eq!(
            slots[..2].iter().map(|&slot| usize::from(slot)).collect::<Vec<_>>(),
            [parity, 1 - parity]
        );
        assert_eq!(slots[2] + slots[3], 5, "one of each B colour");
        assert_eq!(slots[2].abs_diff(slots[3]), 1);
        for vertex_color in 0..4_u8 {
            let slot = VERTEX_COLOR_SLOT[color][usize::from(vertex_color)];
            assert_eq!(slots[usize::from(slot)], vertex_color);
        }
    }
}

#[test]
fn rows_are_in_the_documented_order() {
    let built = mixed();
    for color in 0..COLORS {
        let range = built.color_start[color] as usize..built.color_start[color + 1] as usize;
        let keys = range.map(|tet| (built.tet_sponge[tet], built.tet_slab[tet]));
        assert!(keys.is_sorted(), "tets of colour {color}");
    }
    for color in 0..4 {
        let range = built.vertex_color_start[color]..built.vertex_color_start[color + 1];
        let key = |node: u32| {
            let here = place(&built, node);
            (built.node_sponge[node as usize], [here.z, here.y, here.x])
        };
        let keys: Vec<_> = range.map(key).collect();
        assert!(keys.is_sorted_by(|a, b| a < b), "nodes of vertex colour {color}");
    }
    assert!(built.triangle_sponge.is_sorted());
}

#[test]
fn vertex_colors_are_sublattice_and_parity() {
    let cube = cube(4);
    for node in 0..vertex_end(&cube) {
        // In units of half an edge all coordinates are even on A and odd on B.
        let doubled = place(&cube, node) * 2.0 / f64::from(EDGE);
        let odd = doubled.to_array().map(|coordinate| coordinate.rem_euclid(2.0));
        assert!(odd == [0.0; 3] || odd == [1.0; 3], "node at {doubled}");
        let index_sum = ((doubled - odd[0]) / 2.0).element_sum();
        let wanted = 2.0 * odd[0] + index_sum.rem_euclid(2.0);
        assert_eq!(vertex_color(&cube, node), [0.0, 1.0, 2.0, 3.0].iter().position(|&color| color == wanted));
    }
}

fn vertex_end(lattice: &Lattice) -> u32 {
    lattice.vertex_color_start[4]
}

#[test]
fn slabs_are_the_z_index_of_the_cell() {
    let cube = cube(4);
    for (tet, &slab) in cube.tets.iter().zip(&cube.tet_slab) {
        assert_eq!(place(&cube, tet[0]).z, f64::from(slab) * f64::from(EDGE));
    }
}

#[test]
fn the_same_list_gives_the_same_lattice() {
    assert_eq!(mixed(), mixed());
    let mut other = mixed();
    other.tets.swap(0, 1);
    assert_ne!(mixed(), other);
}

#[test]
fn a_sponge_does_not_depend_on_its_neighbours() {
    let alone = cube(3);
    let both = lattice(&[sponge([3; 3], &block), sponge([2, 4, 3], &block)]);
    assert_eq!(both.sponges[0], alone.sponges[0]);
    for color in 0..COLORS {
        let [own, shared] = [&alone, &both].map(|built| {
            let range = built.tet_range(color, 0);
            let tets = &built.tets[range.start as usize..range.end as usize];
            tets.iter().map(|&tet| corners(built, tet)).collect::<Vec<_>>()
        });
        assert_eq!(own, shared);
    }
}
