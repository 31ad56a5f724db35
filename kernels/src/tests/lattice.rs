//! A small body-centred cubic lattice, enough to give the kernels something to solve.
//!
//! Nodes are ordered by vertex colour, then sponge, then place; tets by colour, then sponge, then place.

use std::collections::BTreeMap;

use crate::pbd::lattice::{COLORS, TetChunk, Topology};

/// A block of cells.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub(super) cells: [i32; 3],
    pub(super) edge: f32,
    pub(super) origin: [f32; 3],
}

/// Nodes and tets of all blocks.
#[derive(Clone, Debug, Default)]
pub(super) struct Lattice {
    pub(super) position: Vec<[f32; 3]>,
    pub(super) sponge: Vec<u32>,
    /// Number of tets at every node; 24 inside.
    pub(super) tets_at: Vec<u32>,
    pub(super) topology: Topology,
}

/// Vertices of the tet of a class in cell 0, in units of half an edge: A nodes are even, B nodes odd.
fn tet(class: usize) -> [[i32; 3]; 4] {
    let d = class / 4;
    let f = (d + 1 + class / 2 % 2) % 3;
    let e = 3 - d - f;
    let sign = 1 - 2 * (class as i32 % 2);
    let along_b = if (d + 1) % 3 == e { sign } else { -sign };
    let unit = |axis: usize, length: i32| std::array::from_fn(|k| if k == axis { length } else { 0 });
    let middle: [i32; 3] = std::array::from_fn(|k| unit(d, 1)[k] + unit(f, sign)[k]);
    let b = |length: i32| std::array::from_fn(|k| middle[k] + unit(e, length)[k]);
    [[0; 3], unit(d, 2), b(along_b), b(-along_b)]
}

/// A or B, and the parity of the cell.
fn color(site: [i32; 3]) -> usize {
    let odd = site[0].rem_euclid(2) as usize;
    2 * odd + site.iter().map(|x| x.div_euclid(2)).sum::<i32>().rem_euclid(2) as usize
}

fn sites(block: &Block, parity: i32) -> impl Iterator<Item = [i32; 3]> {
    let [nx, ny, nz] = block.cells.map(|cells| 2 * cells + 1);
    let each = move |n: i32| (parity..n).step_by(2);
    each(nz).flat_map(move |z| each(ny).flat_map(move |y| each(nx).map(move |x| [x, y, z])))
}

impl Lattice {
    /// The lattice of some blocks; chunks end with a layer of cells, after `target` tets.
    pub(super) fn new(blocks: &[Block], target: usize) -> Self {
        let mut lattice = Self::default();
        let mut node_of = vec![BTreeMap::new(); blocks.len()];
        let used: Vec<_> = blocks.iter().map(used_sites).collect();
        for vertex_color in 0..4 {
            for (sponge, block) in blocks.iter().enumerate() {
                let own = sites(block, vertex_color as i32 / 2).filter(|site| color(*site) == vertex_color);
                for site in own.filter(|site| used[sponge].contains_key(site)) {
                    node_of[sponge].insert(site, lattice.position.len() as u32);
                    let half = block.edge * 0.5;
                    lattice.position.push(std::array::from_fn(|k| block.origin[k] + half * site[k] as f32));
                    lattice.sponge.push(sponge as u32);
                    lattice.tets_at.push(used[sponge][&site]);
                }
            }
            lattice.topology.vertex_color_start[vertex_color + 1] = lattice.position.len() as u32;
        }
        for tet_color in 0..COLORS {
            lattice.topology.slot_vertex_color[tet_color] =
                tet(tet_color / 2).map(|site| (color(site) ^ (tet_color % 2)) as u8);
            for (sponge, block) in blocks.iter().enumerate() {
                lattice.add_tets(tet_color, sponge, block, &node_of[sponge], target);
            }
        }
        lattice.weigh();
        lattice
    }

    /// Tets at a surface stand for more than their own volume, no two kinds of them alike.
    fn weigh(&mut self) {
        let at = &self.tets_at;
        let missing = |tet: &[u32; 4]| tet.iter().map(|node| 24 - at[*node as usize]).sum::<u32>();
        self.topology.weights =
            self.topology.tets.iter().map(|tet| 1.0 + missing(tet) as f32 / 32.0).collect();
    }

    fn add_tets(
        &mut self,
        tet_color: usize,
        sponge: usize,
        block: &Block,
        node_of: &BTreeMap<[i32; 3], u32>,
        target: usize,
    ) {
        let mut layer = None;
        let mut first = self.topology.tets.len();
        for tet in tets_of(block, tet_color / 2).filter(|tet| color(tet[0]) == tet_color % 2) {
            let end = self.topology.tets.len();
            if layer != Some(tet[0][2]) && end - first >= target {
                self.close_chunk(tet_color, sponge, first);
                first = end;
            }
            layer = Some(tet[0][2]);
            self.topology.tets.push(tet.map(|site| node_of[&site]));
        }
        if self.topology.tets.len() > first {
            self.close_chunk(tet_color, sponge, first);
        }
    }

    fn close_chunk(&mut self, tet_color: usize, sponge: usize, first: usize) {
        let topology = &mut self.topology;
        let tets = &topology.tets[first..];
        let nodes = std::array::from_fn(|vertex_color| {
            let slot = topology.slot_vertex_color[tet_color]
                .iter()
                .position(|color| usize::from(*color) == vertex_color)
                .expect("every tet has a node of each colour");
            let own = tets.iter().map(|tet| tet[slot]);
            own.clone().min().unwrap_or(0)..own.max().unwrap_or(0) + 1
        });
        topology.chunks[tet_color].push(TetChunk {
            tets: first as u32..topology.tets.len() as u32,
            nodes,
            sponge: sponge as u32,
        });
    }
}

fn tets_of(block: &Block, class: usize) -> impl Iterator<Item = [[i32; 3]; 4]> {
    let limit = block.cells.map(|cells| 2 * cells);
    let inside = move |site: &[i32; 3]| (0..3).all(|k| (0..=limit[k]).contains(&site[k]));
    sites(block, 0)
        .map(move |base| tet(class).map(|site| std::array::from_fn(|k| base[k] + site[k])))
        .filter(move |tet| tet.iter().all(inside))
}

/// Number of tets at every site that has any.
fn used_sites(block: &Block) -> BTreeMap<[i32; 3], u32> {
    let mut used = BTreeMap::new();
    for site in (0..12).flat_map(|class| tets_of(block, class)).flatten() {
        *used.entry(site).or_insert(0) += 1;
    }
    used
}

#[test]
fn the_lattice_is_what_the_solver_expects() {
    let block = |edge, x| Block { cells: [3, 4, 5], edge, origin: [x, 0.0, 0.0] };
    let lattice = Lattice::new(&[block(0.1, 0.0), block(0.2, 9.0)], 6);
    let topology = &lattice.topology;
    assert_eq!(topology.tets.len(), 2 * (12 * 60 - 4 * (12 + 15 + 20)));
    assert!(lattice.tets_at.iter().all(|count| (1..=24).contains(count)));
    let mut covered = 0;
    for (tet_color, chunks) in topology.chunks.iter().enumerate() {
        assert!(chunks.len() > 2);
        let mut free = [0; 4];
        let mut touched = vec![false; lattice.position.len()];
        for chunk in chunks {
            assert_eq!(chunk.tets.start, covered);
            covered = chunk.tets.end;
            for (range, free) in chunk.nodes.iter().zip(&mut free) {
                assert!(range.start >= *free, "ranges of chunks rise and are disjoint");
                *free = range.end;
            }
            for tet in &topology.tets[chunk.tets.start as usize..chunk.tets.end as usize] {
                for (node, vertex_color) in tet.iter().zip(topology.slot_vertex_color[tet_color]) {
                    let vertex_color = usize::from(vertex_color);
                    let own = topology.vertex_color_start[vertex_color]
                        ..topology.vertex_color_start[vertex_color + 1];
                    assert!(own.contains(node) && chunk.nodes[vertex_color].contains(node));
                    assert!(!std::mem::replace(&mut touched[*node as usize], true));
                }
                let p = tet.map(|node| glam::Vec3::from_array(lattice.position[node as usize]));
                let edge = [0.1_f32, 0.2][chunk.sponge as usize];
                let volume = (p[1] - p[0]).dot((p[2] - p[0]).cross(p[3] - p[0])) / 6.0;
                assert!((volume / edge.powi(3) * 12.0 - 1.0).abs() < 1e-4);
            }
        }
    }
    assert_eq!(covered as usize, topology.tets.len());
}
