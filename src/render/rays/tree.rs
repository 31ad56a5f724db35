//! A tree of boxes over triangles of sponges, or over balls.

use super::setting::NEAR;
use crate::render::number::{greater, lesser};
use glam::Vec3;
use std::ops::Range;

/// Most triangles of a leaf.
const LEAF: usize = 4;
/// Most parts that wait for their turn; the tree is balanced, so that 2^32 triangles fit.
const DEPTH: usize = 64;

/// Something that rays meet.
pub(in crate::render) trait Shape {
    /// More about the place where a ray meets it.
    type Place: Copy;

    /// Lowest and highest corner of a box around it (m).
    fn bounds(&self) -> (Vec3, Vec3);

    /// Distance and place where a ray meets it from outside, nearer than a distance.
    fn meet(&self, origin: Vec3, direction: Vec3, nearest: f32) -> Option<(f32, Self::Place)>;
}

/// Corners of a triangle; rays meet its outer side only, at the weights of its second and third corner.
pub(in crate::render) type Triangle = [Vec3; 3];

/// A ball: middle and radius (m). Rays meet it with its normal.
pub(in crate::render) type Ball = (Vec3, f32);

/// Where a ray meets something.
#[derive(Clone, Copy, Debug)]
pub(in crate::render) struct Hit<P> {
    /// Distance along the ray.
    pub(in crate::render) distance: f32,
    /// Index of what it meets.
    pub(in crate::render) index: u32,
    pub(in crate::render) place: P,
}

/// Sides of the boxes of the parts of a node, axis by axis.
#[cfg(feature = "gpu")]
pub(in crate::render) type Sides = [[f32; WIDTH]; 3];

/// Children of a node: their boxes are compared with a ray at once.
pub(in crate::render) const WIDTH: usize = 4;

/// A part of the tree.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// First shape of a leaf, or a node.
    first: u32,
    /// Shapes of a leaf; 0 for a node.
    count: u32,
}

/// Up to four parts with their boxes, axis by axis.
#[derive(Clone, Copy, Debug)]
struct Node {
    low: [[f32; WIDTH]; 3],
    high: [[f32; WIDTH]; 3],
    parts: [Part; WIDTH],
    /// Number of parts.
    width: usize,
}

/// The tree.
#[derive(Debug)]
pub(in crate::render) struct Tree<S> {
    nodes: Vec<Node>,
    shapes: Vec<(u32, S)>,
}

impl<S: Shape> Tree<S> {
    /// A tree of shapes.
    pub(in crate::render) fn new(shapes: impl Iterator<Item = S>) -> Self {
        let shapes: Vec<_> = shapes.enumerate().map(|(index, shape)| (index as u32, shape)).collect();
        let mut tree = Self { nodes: Vec::new(), shapes };
        let count = tree.shapes.len();
        if count > 0 {
            tree.build(0..count);
        }
        tree
    }

    /// Box around some shapes (m).
    fn bounds(&self, shapes: &Range<usize>) -> (Vec3, Vec3) {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (_, shape) in &self.shapes[shapes.clone()] {
            let (a, b) = shape.bounds();
            low = low.min(a);
            high = high.max(b);
        }
        (low, high)
    }

    /// Sorts shapes into two halves along the longest side of their box.
    fn halves(&mut self, shapes: &Range<usize>) -> [Range<usize>; 2] {
        let (low, high) = self.bounds(shapes);
        let axis = (high - low).max_position();
        let middle = usize::midpoint(shapes.start, shapes.end);
        let centre = |shape: &S| {
            let (a, b) = shape.bounds();
            a[axis] + b[axis]
        };
        self.shapes[shapes.clone()]
            .select_nth_unstable_by(middle - shapes.start, |a, b| centre(&a.1).total_cmp(&centre(&b.1)));
        [shapes.start..middle, middle..shapes.end]
    }

    fn build(&mut self, shapes: Range<usize>) -> u32 {
        let mut ranges = vec![shapes];
        while ranges.len() < WIDTH && ranges.iter().any(|range| range.len() > LEAF) {
            let cut = |range: Range<usize>| {
                if range.len() > LEAF { self.halves(&range).to_vec() } else { vec![range] }
            };
            ranges = ranges.into_iter().flat_map(cut).collect();
        }
        let own = self.nodes.len();
        let mut node = Node {
            low: [[0.0; WIDTH]; 3],
            high: [[0.0; WIDTH]; 3],
            parts: [Part { first: 0, count: 0 }; WIDTH],
            width: ranges.len(),
        };
        self.nodes.push(node);
        for (lane, range) in ranges.into_iter().enumerate() {
            let (low, high) = self.bounds(&range);
            for axis in 0..3 {
                (node.low[axis][lane], node.high[axis][lane]) = (low[axis], high[axis]);
            }
            node.parts[lane] = if range.len() > LEAF {
                Part { first: self.build(range), count: 0 }
            } else {
                Part { first: range.start as u32, count: range.len() as u32 }
            };
        }
        self.nodes[own] = node;
        own as u32
    }

    /// The nodes with the boxes of their parts, axis by axis, and first shape (or node) and number of shapes of every part.
    #[cfg(feature = "gpu")]
    pub(in crate::render) fn parts(
        &self,
    ) -> impl Iterator<Item = (Sides, Sides, [Option<(u32, u32)>; WIDTH])> {
        self.nodes.iter().map(|node| {
            let part =
                |lane: usize| (lane < node.width).then(|| (node.parts[lane].first, node.parts[lane].count));
            (node.low, node.high, [0, 1, 2, 3].map(part))
        })
    }

    /// The shapes in the order of the leaves, with their index.
    #[cfg(feature = "gpu")]
    pub(in crate::render) fn shapes(&self) -> impl Iterator<Item = (u32, S)>
    where
        S: Copy,
    {
        self.shapes.iter().copied()
    }

    /// The nearest shape on a ray that is nearer than a distance.
    pub(in crate::render) fn hit(
        &self,
        origin: Vec3,
        direction: Vec3,
        mut nearest: f32,
    ) -> Option<Hit<S::Place>> {
        if self.nodes.is_empty() {
            return None;
        }
        let (origins, inverse) = (origin.to_array(), direction.recip().to_array());
        let mut waiting = [(Part { first: 0, count: 0 }, 0.0_f32); DEPTH];
        let (mut count, mut best) = (1, None);
        while count > 0 {
            count -= 1;
            let (part, enter) = waiting[count];
            if enter >= nearest {
                continue;
            }
            if part.count > 0 {
                let leaf = part.first as usize..(part.first + part.count) as usize;
                for (index, shape) in &self.shapes[leaf] {
                    if let Some((distance, place)) = shape.meet(origin, direction, nearest) {
                        nearest = distance;
                        best = Some(Hit { distance, index: *index, place });
                    }
                }
                continue;
            }
            let node = &self.nodes[part.first as usize];
            let (near, far) = node.spans(origins, inverse);
            let bottom = count;
            for lane in 0..node.width {
                if near[lane] <= far[lane] && near[lane] < nearest && count < DEPTH {
                    // The nearest is on top.
                    let mut place = count;
                    while place > bottom && waiting[place - 1].1 < near[lane] {
                        waiting[place] = waiting[place - 1];
                        place -= 1;
                    }
                    waiting[place] = (node.parts[lane], near[lane]);
                    count += 1;
                }
            }
        }
        best
    }
}

impl Node {
    /// Where a ray enters and leaves the boxes. Alone, it becomes vectors.
    #[inline(never)]
    fn spans(&self, origin: [f32; 3], inverse: [f32; 3]) -> ([f32; WIDTH], [f32; WIDTH]) {
        let (mut near, mut far) = ([0.0; WIDTH], [f32::INFINITY; WIDTH]);
        for axis in 0..3 {
            for lane in 0..WIDTH {
                let a = (self.low[axis][lane] - origin[axis]) * inverse[axis];
                let b = (self.high[axis][lane] - origin[axis]) * inverse[axis];
                near[lane] = greater(lesser(a, b), near[lane]);
                far[lane] = lesser(greater(a, b), far[lane]);
            }
        }
        (near, far)
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
