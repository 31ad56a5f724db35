//! A tree of boxes over triangles of sponges, or over balls.

use super::setting::NEAR;
use glam::Vec3;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Deepest place that waits for its turn; the tree is balanced, so that 2^32 triangles fit.
const DEPTH: usize = 64;

/// Something that rays meet.
pub(super) trait Shape {
    /// More about the place where a ray meets it.
    type Place: Copy;

    /// Lowest and highest corner of a box around it (m).
    fn bounds(&self) -> (Vec3, Vec3);

    /// Distance and place where a ray meets it from outside, nearer than a distance.
    fn meet(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<(f32, Self::Place)>;
}

/// Corners of a triangle; rays meet its outer side only, at the weights of its second and third corner.
pub(super) type Triangle = [Vec3; 3];

/// A ball: middle and radius (m). Rays meet it with its normal.
pub(super) type Ball = (Vec3, f32);

/// Where a ray meets something.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit<P> {
    /// Distance along the ray.
    pub(super) distance: f32,
    /// Index of what it meets.
    pub(super) index: u32,
    pub(super) place: P,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: Vec3,
    high: Vec3,
    /// First shape of a leaf, or the second child; the first child follows its parent.
    first: u32,
    /// Shapes of a leaf, 0 for a branch.
    count: u32,
}

/// The tree.
#[derive(Debug)]
pub(super) struct Tree<S> {
    nodes: Vec<Node>,
    shapes: Vec<(u32, S)>,
}

impl<S: Shape> Tree<S> {
    /// A tree of shapes.
    pub(super) fn new(shapes: impl Iterator<Item = S>) -> Self {
        let shapes: Vec<_> = shapes.enumerate().map(|(index, shape)| (index as u32, shape)).collect();
        let mut tree = Self { nodes: Vec::new(), shapes };
        let count = tree.shapes.len();
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    fn build(&mut self, first: usize, end: usize) -> usize {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (_, shape) in &self.shapes[first..end] {
            let (a, b) = shape.bounds();
            low = low.min(a);
            high = high.max(b);
        }
        let own = self.nodes.len();
        self.nodes.push(Node { low, high, first: first as u32, count: (end - first) as u32 });
        if end - first > LEAF {
            let axis = (high - low).max_position();
            let middle = (first + end) / 2;
            let centre = |shape: &S| {
                let (a, b) = shape.bounds();
                a[axis] + b[axis]
            };
            self.shapes[first..end]
                .select_nth_unstable_by(middle - first, |a, b| centre(&a.1).total_cmp(&centre(&b.1)));
            self.build(first, middle);
            let second = self.build(middle, end);
            self.nodes[own].count = 0;
            self.nodes[own].first = second as u32;
        }
        own
    }

    /// The nearest shape on a ray that is nearer than a distance.
    pub(super) fn hit(&self, origin: Vec3, direction: Vec3, mut nearest: f32) -> Option<Hit<S::Place>> {
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
        let mut waiting = [(0_u32, 0.0_f32); DEPTH];
        let (mut count, mut at, mut best) = (0, 0, None);
        loop {
            let node = self.nodes[at];
            if node.count > 0 {
                let leaf = node.first as usize..(node.first + node.count) as usize;
                for (index, shape) in &self.shapes[leaf] {
                    if let Some((distance, place)) = shape.meet(origin, direction, nearest) {
                        nearest = distance;
                        best = Some(Hit { distance, index: *index, place });
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
                        waiting[count] = (far as u32, b);
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
                    at = waiting[count].0 as usize;
                    break;
                }
            }
        }
    }
}

impl Shape for Triangle {
    type Place = [f32; 2];

    fn bounds(&self) -> (Vec3, Vec3) {
        let [a, b, c] = *self;
        (a.min(b).min(c), a.max(b).max(c))
    }

    fn meet(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<(f32, [f32; 2])> {
        let [a, b, c] = *self;
        let (e, f) = (b - a, c - a);
        let p = direction.cross(f);
        let determinant = e.dot(p);
        if determinant <= 1e-14 {
            return None;
        }
        let s = origin - a;
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
        (t > NEAR && t < nearest).then(|| (t, [u / determinant, v / determinant]))
    }
}

impl Shape for Ball {
    type Place = Vec3;

    fn bounds(&self) -> (Vec3, Vec3) {
        (self.0 - self.1, self.0 + self.1)
    }

    fn meet(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<(f32, Vec3)> {
        let (centre, radius) = *self;
        let offset = origin - centre;
        let middle = -offset.dot(direction);
        let square = radius * radius - (offset + direction * middle).length_squared();
        if square <= 0.0 {
            return None;
        }
        let t = middle - square.sqrt();
        (t > NEAR && t < nearest).then(|| (t, (offset + direction * t) / radius))
    }
}
