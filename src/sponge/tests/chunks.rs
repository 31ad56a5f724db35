use super::*;
use crate::sponge::{COLORS, TetChunk, chunks, ellipsoid};

/// The fault of the chunks of a colour, if any.
fn fault(lattice: &Lattice, color: usize, cut: &[TetChunk], target: u32) -> Option<&'static str> {
    let mut next = lattice.color_start[color];
    let mut free = [0; 4];
    for (index, chunk) in cut.iter().enumerate() {
        let tets = chunk.tets.start as usize..chunk.tets.end as usize;
        if chunk.tets.start != next || tets.is_empty() {
            return Some("gap");
        }
        next = chunk.tets.end;
        if lattice.tet_sponge[tets.clone()].iter().any(|&sponge| sponge != chunk.sponge) {
            return Some("two sponges");
        }
        let last_of_sponge = cut.get(index + 1).is_none_or(|other| other.sponge != chunk.sponge);
        if chunk.tets.end - chunk.tets.start < target && !last_of_sponge {
            return Some("too small");
        }
        if !last_of_sponge && lattice.tet_slab[tets.end - 1] == lattice.tet_slab[tets.end] {
            return Some("cut within a slab");
        }
        for (vertex_color, range) in chunk.nodes.iter().enumerate() {
            let nodes = || lattice.tets[tets.clone()].iter().flatten().copied();
            let of_color =
                lattice.vertex_color_start[vertex_color]..lattice.vertex_color_start[vertex_color + 1];
            let own: Vec<u32> = nodes().filter(|node| of_color.contains(node)).collect();
            if own.iter().min() != Some(&range.start) || own.iter().max() != Some(&(range.end - 1)) {
                return Some("wrong node range");
            }
            if range.start < free[vertex_color] {
                return Some("shared nodes");
            }
            free[vertex_color] = range.end;
        }
    }
    (next != lattice.color_start[color + 1]).then_some("tets left over")
}

fn samples() -> Vec<Lattice> {
    vec![
        cube(2),
        cube(5),
        lattice(&[sponge([9, 8, 10], &ellipsoid)]),
        lattice(&[sponge([1, 1, 6], &block), sponge([6, 1, 1], &block)]),
        mixed(),
    ]
}

#[test]
fn chunks_of_a_color_share_no_nodes() {
    for built in samples() {
        for target in [0, 1, 7, 30, 1_000_000] {
            let cut = chunks(&built, target as usize);
            for (color, cut) in cut.iter().enumerate() {
                assert_eq!(fault(&built, color, cut, target), None, "colour {color}, target {target}");
            }
        }
    }
}

#[test]
fn a_planted_fault_is_found() {
    let built = mixed();
    let good = chunks(&built, 7)[3].clone();
    assert!(good.len() > 4);
    let plant = |change: &dyn Fn(&mut Vec<TetChunk>)| {
        let mut bad = good.clone();
        change(&mut bad);
        fault(&built, 3, &bad, 7)
    };
    assert_eq!(plant(&|_| ()), None);
    assert_eq!(plant(&|cut| cut.truncate(cut.len() - 1)), Some("tets left over"));
    assert_eq!(plant(&|cut| cut.retain(|chunk| chunk.tets != good[1].tets)), Some("gap"));
    assert_eq!(plant(&|cut| cut[1].nodes[2].end += 1), Some("wrong node range"));
    assert_eq!(plant(&|cut| cut[0].tets.end = built.color_start[4]), Some("two sponges"));
    assert_eq!(fault(&built, 3, &good, 100), Some("too small"));
    let mut mixed_up = built.clone();
    let tets = good[0].tets.end as usize - 1..good[0].tets.end as usize + 1;
    mixed_up.tets.swap(tets.start, tets.end - 1);
    let mut overlap = good.clone();
    for vertex_color in 0..4 {
        let inner = |tet: &[u32; 4]| {
            let of_color = built.vertex_color_start[vertex_color]..built.vertex_color_start[vertex_color + 1];
            tet.iter().copied().find(|node| of_color.contains(node))
        };
        for chunk in &mut overlap[..2] {
            let rows = &mixed_up.tets[chunk.tets.start as usize..chunk.tets.end as usize];
            let nodes: Vec<u32> = rows.iter().filter_map(inner).collect();
            chunk.nodes[vertex_color] =
                nodes.iter().min().copied().unwrap_or(0)..nodes.iter().max().map_or(0, |n| n + 1);
        }
    }
    assert_eq!(fault(&mixed_up, 3, &overlap, 7), Some("shared nodes"));
}

#[test]
fn large_targets_give_one_chunk_for_each_sponge() {
    let built = mixed();
    for (color, cut) in chunks(&built, usize::MAX).iter().enumerate() {
        let sponges: Vec<u32> = cut.iter().map(|chunk| chunk.sponge).collect();
        assert_eq!(sponges, [0, 1, 2], "colour {color}");
        for chunk in cut {
            assert_eq!(chunk.tets, built.tet_range(color, chunk.sponge));
        }
    }
    assert!(chunks(&Lattice::default(), 8).iter().all(Vec::is_empty));
}

#[test]
fn rows_can_be_handed_out_without_overlap() {
    // A sweep that takes mutable rows by splitting alone: counts the tets at each node.
    let built = mixed();
    let mut count = vec![0; built.node_count()];
    for color in 0..COLORS {
        let cut = &chunks(&built, 20)[color];
        for vertex_color in 0..4 {
            let slot = usize::from(crate::sponge::VERTEX_COLOR_SLOT[color][vertex_color]);
            let mut rest = &mut count[..];
            let mut start = 0;
            for chunk in cut {
                let range = &chunk.nodes[vertex_color];
                let (own, after) = rest[(range.start - start) as usize..].split_at_mut(range.len());
                for tet in &built.tets[chunk.tets.start as usize..chunk.tets.end as usize] {
                    own[(tet[slot] - range.start) as usize] += 1;
                }
                (rest, start) = (after, range.end);
            }
        }
    }
    assert_eq!(count, built.node_tet_count);
}
