//! A tree of boxes over the triangles of the sponges.

use glam::Vec3;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Deepest place that waits for its turn; the tree is balanced, so that 2^32 triangles fit.
const DEPTH: usize = 64;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Distance along the ray.
    pub(super) distance: f32,
    /// Index of the triangle.
    pub(super) triangle: u32,
    /// Weights of its second and third corner.
    pub(super) at: [f32; 2],
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// First triangle of a leaf, or the second child; the first child follows its parent.
    first: u32,
    /// Triangles of a leaf, 0 for a branch.
    count: u32,
}

/// The tree; it sees the outer side of triangles only.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<Node>,
    triangles: Vec<(u32, [Vec3; 3])>,
}

impl Tree {
    /// A tree of corners of triangles.
    pub(super) fn new(corners: impl Iterator<Item = [Vec3; 3]>) -> Self {
        let triangles: Vec<_> = corners.enumerate().map(|(index, corners)| (index as u32, corners)).collect();
        let mut tree = Self { nodes: Vec::new(), triangles };
        let count = tree.triangles.len();
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    fn build(&mut self, first: usize, end: usize) -> usize {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (_, corners) in &self.triangles[first..end] {
            for corner in corners {
                low = low.min(*corner);
                high = high.max(*corner);
            }
        }
        let own = self.nodes.len();
        self.nodes.push(Node { low, high, first: first as u32, count: (end - first) as u32 });
        if end - first > LEAF {
            let side = high - low;
            let axis = side.max_position();
            let middle = (first + end) / 2;
            let centre = |corners: &[Vec3; 3]| corners[0][axis] + corners[1][axis] + corners[2][axis];
            self.triangles[first..end]
                .select_nth_unstable_by(middle - first, |a, b| centre(&a.1).total_cmp(&centre(&b.1)));
            self.build(first, middle);
            let second = self.build(middle, end);
            self.nodes[own].count = 0;
            self.nodes[own].first = second as u32;
        }
        own
    }

    /// The nearest triangle on a ray that is nearer than a distance.
    pub(super) fn hit(&self, origin: Vec3, direction: Vec3, mut nearest: f32) -> Option<Hit> {
        let inverse = direction.recip();
        let enter = |node: &Node, nearest: f32| {
            let (a, b) = ((node.low - origin) * inverse, (node.high - origin) * inverse);
            let (near, far) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            if near <= far && near < nearest { near } else { f32::INFINITY }
        };
        let root = self.nodes.first()?;
        if enter(root, nearest) == f32::INFINITY {
            return None;
        }
        let mut waiting = [(0_usize, 0.0_f32); DEPTH];
        let (mut count, mut at, mut best) = (0, 0, None);
        loop {
            let node = self.nodes[at];
            if node.count > 0 {
                let leaf = node.first as usize..(node.first + node.count) as usize;
                for (index, corners) in &self.triangles[leaf] {
                    if let Some((distance, at)) = meet(origin, direction, corners, nearest) {
                        nearest = distance;
                        best = Some(Hit { distance, triangle: *index, at });
                    }
                }
            } else {
                let (mut near, mut far) = (at + 1, node.first as usize);
                let (mut a, mut b) = (enter(&self.nodes[near], nearest), enter(&self.nodes[far], nearest));
                if b < a {
                    ((near, a), (far, b)) = ((far, b), (near, a));
                }
                if a < f32::INFINITY {
                    if b < f32::INFINITY && count < DEPTH {
                        waiting[count] = (far, b);
                        count += 1;
                    }
                    at = near;
                    continue;
                }
            }
            loop {
                if count == 0 {
                    return best;
                }
                count -= 1;
                if waiting[count].1 < nearest {
                    at = waiting[count].0;
                    break;
                }
            }
        }
    }
}

/// Distance and weights where a ray meets the outer side of a triangle.
fn meet(origin: Vec3, direction: Vec3, [a, b, c]: &[Vec3; 3], nearest: f32) -> Option<(f32, [f32; 2])> {
    let (e, f) = (*b - *a, *c - *a);
    let p = direction.cross(f);
    let determinant = e.dot(p);
    if determinant <= 1e-14 {
        return None;
    }
    let s = origin - *a;
    let u = s.dot(p);
    if u < 0.0 || u > determinant {
        return None;
    }
    let q = s.cross(e);
    let v = direction.dot(q);
    if v < 0.0 || u + v > determinant {
        return None;
    }
    let t = f.dot(q) / determinant;
    (t > 1e-6 && t < nearest).then(|| (t, [u / determinant, v / determinant]))
}
