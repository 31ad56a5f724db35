//! Images in the walls of the container: one by every combination of the walls near a point.

use glam::Vec3;

use crate::{layout::constants, params::Params};

constants! {
    /// Number of ways in which walls mirror: along every axis by none, by the lower, or by the upper one.
    pub(crate) const MIRRORS: usize = 27;
}

/// Rank of an image that is not there.
const NONE: u8 = u8::MAX;

/// The walls near a point: two bits an axis, the lower wall first.
pub(crate) type NearWalls = u8;

/// Rank among the images of a point near the given walls of the one by the given mirrors; that by none is the point itself.
static RANKS: [[u8; MIRRORS]; 64] = ranks();

const fn ranks() -> [[u8; MIRRORS]; 64] {
    let mut ranks = [[NONE; MIRRORS]; 64];
    let mut near = 0;
    while near < 64 {
        let (mut rank, mut mirrors) = (0, 0);
        while mirrors < MIRRORS {
            let (mut axis, mut is_there) = (0, true);
            while axis < 3 {
                let by = mirrors_of(mirrors, axis);
                is_there = is_there && (by == 0 || (near >> (2 * axis + by - 1)) & 1 == 1);
                axis += 1;
            }
            if is_there {
                ranks[near][mirrors] = rank;
                rank += 1;
            }
            mirrors += 1;
        }
        near += 1;
    }
    ranks
}

/// Along an axis: 0 for none, 1 for the lower wall, 2 for the upper one.
#[inline(always)]
pub(super) const fn mirrors_of(mirrors: usize, axis: usize) -> usize {
    [mirrors / 9, mirrors / 3 % 3, mirrors % 3][axis]
}

/// Rank of the image by the mirrors; 0 is the point itself.
#[inline(always)]
pub(super) fn rank(near: NearWalls, mirrors: usize) -> Option<u32> {
    let rank = RANKS[usize::from(near)][mirrors];
    (rank != NONE).then_some(u32::from(rank))
}

/// Number of images of a point, with the point itself.
pub(super) fn count(near: NearWalls) -> u32 {
    (0..3).map(|axis| 1 + (near >> (2 * axis) & 3).count_ones()).product()
}

/// The walls that are near a point. Images reach so far that a particle that sees one has one of its own. Only then is the force by
/// mirrored pressures the transpose of the divergence.
#[inline(always)]
pub(super) fn near_walls(params: &Params, point: Vec3) -> NearWalls {
    walls_within(params, point, params.fluid.smoothing.support_radius)
}

/// The walls within a distance of a point.
#[inline(always)]
pub(crate) fn walls_within(params: &Params, point: Vec3, reach: f32) -> NearWalls {
    let Some((low, high)) = params.walls else { return 0 };
    let mut near = 0;
    for axis in 0..3 {
        near |= u8::from((point[axis] - low[axis]).abs() < reach) << (2 * axis);
        near |= u8::from((point[axis] - high[axis]).abs() < reach) << (2 * axis + 1);
    }
    near
}

/// Calls `visit` with the places of all images of a point near the walls, in the order of their ranks. It gives the axes whose walls mirror
/// them as well, a bit each. The first is the point itself.
#[inline(always)]
pub(crate) fn visit(params: &Params, point: Vec3, near: NearWalls, mut visit: impl FnMut(Vec3, u32)) {
    let (low, high) = params.walls.unwrap_or_default();
    for mirrors in (0..MIRRORS).filter(|mirrors| rank(near, *mirrors).is_some()) {
        let (mut place, mut axes) = (point, 0);
        for axis in 0..3 {
            let wall = match mirrors_of(mirrors, axis) {
                0 => continue,
                1 => low[axis],
                _ => high[axis],
            };
            place[axis] = 2.0 * wall - point[axis];
            axes |= 1 << axis;
        }
        visit(place, axes);
    }
}
