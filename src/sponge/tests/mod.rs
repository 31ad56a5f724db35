//! Tests of the lattice: counts are exact integers, and every comparison has a negative control with a planted fault.

mod chunks;
mod counts;
mod errors;
mod geometry;
mod layout;
mod masks;
mod pits;

use glam::{DVec3, Vec3};

use super::{Lattice, LatticeSponge, block};

/// An edge with an exact reciprocal, so that positions and rest volumes carry no rounding.
const EDGE: f32 = 0.0625;

fn sponge<'a>(cells: [u32; 3], keep: &'a dyn Fn(Vec3) -> bool) -> LatticeSponge<'a> {
    LatticeSponge { edge: EDGE, cells, origin: Vec3::ZERO, keep, has_room: &block, may_be_empty: false }
}

fn lattice(sponges: &[LatticeSponge<'_>]) -> Lattice {
    Lattice::new(sponges).expect("the sponges of the tests are valid")
}

fn cube(n: u32) -> Lattice {
    lattice(&[sponge([n; 3], &block)])
}

/// Three sponges of different size, shape, edge and place.
fn mixed() -> Lattice {
    lattice(&[
        LatticeSponge {
            edge: 0.01,
            cells: [6, 4, 9],
            origin: Vec3::new(-0.3, 0.1, 0.7),
            keep: &super::ellipsoid,
            has_room: &block,
            may_be_empty: false,
        },
        LatticeSponge {
            edge: 0.02,
            cells: [3, 5, 2],
            origin: Vec3::new(0.5, 0.0, -0.2),
            keep: &block,
            has_room: &block,
            may_be_empty: false,
        },
        LatticeSponge {
            edge: 0.013,
            cells: [7, 4, 6],
            origin: Vec3::new(0.0, 1.0, 0.0),
            keep: &super::cylinder(super::Axis::Y),
            has_room: &block,
            may_be_empty: false,
        },
    ])
}

fn place(lattice: &Lattice, node: u32) -> DVec3 {
    let [x, y, z, _] = lattice.position[node as usize].map(f64::from);
    DVec3::new(x, y, z)
}

fn corners(lattice: &Lattice, tet: [u32; 4]) -> [DVec3; 4] {
    tet.map(|node| place(lattice, node))
}

/// Volume of a tet, negative if it is inverted.
fn volume([p0, p1, p2, p3]: [DVec3; 4]) -> f64 {
    (p1 - p0).dot((p2 - p0).cross(p3 - p0)) / 6.0
}

/// Numbers in [0, 1) from a linear congruential generator.
fn random(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    f64::from(u32::try_from(*seed >> 32).expect("half of the bits remain")) / 4_294_967_296.0
}
