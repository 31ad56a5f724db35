//! Refuses sponges inside each other, which contact could not separate.

use std::collections::BTreeSet;

use glam::{DVec3, Vec3};

use crate::{
    scene::{Scene, Solver, Sponge},
    sponge::Lattice,
    world::WorldError,
};

/// Distance from a node inside to a node of another sponge, in edges, below which they overlap. No point of the lattice is
/// further from a node. Nodes of a face that only touches are at least a whole edge away.
const NEAR: f64 = 0.6;

/// Refuses sponges that touch each other and overlap by more than about half an edge.
pub(super) fn check(scene: &Scene, lattice: &Lattice) -> Result<(), WorldError> {
    let touches = |sponge: &Sponge| sponge.solver == Solver::Vbd;
    for (index, sponge) in scene.sponges.iter().enumerate() {
        for (other_index, other) in scene.sponges.iter().enumerate() {
            let apart = |axis: usize| {
                sponge.maximum()[axis] < other.position[axis] || other.maximum()[axis] < sponge.position[axis]
            };
            let are_at_once = index != other_index && !sponge.added && !other.added;
            let may = are_at_once && touches(sponge) && touches(other) && !(0..3).any(apart);
            if may && is_inside(lattice, other_index, (index, sponge)) {
                let [first, second] = [sponge, other].map(|sponge| sponge.name.clone());
                return Err(WorldError::Overlap { first, second });
            }
        }
    }
    Ok(())
}

/// Whether a node of one sponge lies well inside another.
fn is_inside(lattice: &Lattice, node_of: usize, (index, sponge): (usize, &Sponge)) -> bool {
    let half = 0.5 * f64::from(sponge.edge);
    let site = |point: DVec3| (point - sponge.position.as_dvec3()) / half;
    let nodes = |index: usize| {
        let own = move |node: &usize| lattice.node_sponge[*node] as usize == index;
        (0..lattice.node_count()).filter(own)
    };
    let place = |node: usize| {
        let [x, y, z, _] = lattice.position[node];
        Vec3::new(x, y, z).as_dvec3()
    };
    let inner: BTreeSet<[i64; 3]> = nodes(index)
        .filter(|node| lattice.node_tet_count[*node] == 24)
        .map(|node| site(place(node)).round().to_array().map(|site| site as i64))
        .collect();
    nodes(node_of).any(|node| {
        let at = site(place(node));
        let base = at.round();
        let around =
            (0..27).map(|k| DVec3::new(f64::from(k % 3), f64::from(k / 3 % 3), f64::from(k / 9)) - 1.0);
        let mut near = around.map(|step| base + step).filter(|site| (*site - at).length() < 2.0 * NEAR);
        near.any(|site| inner.contains(&site.to_array().map(|site| site as i64)))
    })
}
