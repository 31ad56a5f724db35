//! Intersection of rays with the shapes of bodies.

use super::{DrawnBody, Look};
use crate::rigid::{Compound, Shape};
use glam::{Mat3, Vec3};

/// A body prepared for intersection.
#[derive(Debug)]
pub(super) struct Solid<'a> {
    pub(super) shape: &'a Shape,
    /// Index in the picture's list, which also selects the colour.
    pub(super) index: usize,
    pub(super) position: Vec3,
    /// Local to world.
    pub(super) rotation: Mat3,
    /// Radius of a ball around the origin that holds the shape; infinite for a plane.
    pub(super) radius: f32,
    pub(super) look: Look,
    colour: Option<Vec3>,
}

/// Colours of bodies without one of their own, by their place in the list: linear red, green and blue.
const COLOURS: [Vec3; 6] = [
    Vec3::new(0.50, 0.035, 0.025),
    Vec3::new(0.05, 0.14, 0.42),
    Vec3::new(0.75, 0.72, 0.66),
    Vec3::new(0.62, 0.25, 0.04),
    Vec3::new(0.10, 0.33, 0.24),
    Vec3::new(0.10, 0.12, 0.16),
];

/// The part of a ray inside a shape.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) enter: f32,
    pub(super) exit: f32,
    /// Outward normal where it enters and where it leaves.
    pub(super) normal: Vec3,
    pub(super) exit_normal: Vec3,
}

impl<'a> Solid<'a> {
    /// The body, or nothing where its pose or size is not valid.
    pub(super) fn new(index: usize, body: &DrawnBody<'a>) -> Option<Self> {
        let radius = match body.shape {
            Shape::Plane => f32::INFINITY,
            Shape::Sphere { radius } => *radius,
            Shape::Cuboid { half_extents } => half_extents.length(),
            Shape::Capsule { half_height, radius } => half_height + radius,
            shape @ (Shape::Hull { .. } | Shape::Compound(_)) => shape.bounding_radius(),
        };
        let rotation = body.state.rotation;
        let usable = body.state.position.is_finite()
            && rotation.is_finite()
            && rotation.length_squared() > 1e-12
            && radius > 0.0;
        usable.then(|| Self {
            shape: body.shape,
            index,
            position: body.state.position,
            rotation: Mat3::from_quat(rotation.normalize()),
            radius,
            look: body.look,
            colour: body.colour.filter(|colour| colour.is_finite()),
        })
    }

    /// Whether light passes the body.
    pub(super) fn is_clear(&self) -> bool {
        self.look != Look::Solid
    }

    /// The colour of the body, if it has one of its own: linear red, green and blue.
    pub(super) fn own_colour(&self) -> Option<Vec3> {
        self.colour
    }

    /// The colour of the body: linear red, green and blue.
    pub(super) fn colour(&self) -> Vec3 {
        self.colour.unwrap_or(COLOURS[self.index % COLOURS.len()])
    }

    pub(super) fn is_plane(&self) -> bool {
        matches!(self.shape, Shape::Plane)
    }

    pub(super) fn local(&self, point: Vec3) -> Vec3 {
        self.rotation.transpose() * (point - self.position)
    }

    /// The part of a ray inside the shape, if the ray starts outside and hits; normals in world axes.
    pub(super) fn span(&self, origin: Vec3, direction: Vec3) -> Option<Span> {
        let inverse = self.rotation.transpose();
        let (o, d) = (inverse * (origin - self.position), inverse * direction);
        let span = match self.shape {
            Shape::Plane => plane(o, d),
            Shape::Sphere { radius } => ball(o, d, *radius),
            Shape::Cuboid { half_extents } => cuboid(o, d, *half_extents),
            Shape::Capsule { half_height, radius } => capsule(o, d, *half_height, *radius),
            Shape::Hull { planes, .. } => hull(o, d, planes),
            Shape::Compound(compound) => union(o, d, compound),
        }?;
        (span.enter > 0.0).then(|| Span {
            normal: self.rotation * span.normal,
            exit_normal: self.rotation * span.exit_normal,
            ..span
        })
    }

    /// Signed distance of a point from the surface (m), negative inside. That of a hull is exact near its faces only.
    pub(super) fn distance(&self, point: Vec3) -> f32 {
        let p = self.local(point);
        match self.shape {
            Shape::Plane => p.y,
            Shape::Sphere { radius } => p.length() - radius,
            Shape::Cuboid { half_extents } => {
                let q = p.abs() - *half_extents;
                q.max(Vec3::ZERO).length() + q.max_element().min(0.0)
            }
            Shape::Capsule { half_height, radius } => {
                (p - Vec3::Y * p.y.clamp(-half_height, *half_height)).length() - radius
            }
            Shape::Hull { planes, .. } => {
                planes.iter().map(|(normal, offset)| normal.dot(p) - offset).fold(f32::MIN, f32::max)
            }
            Shape::Compound(compound) => {
                compound.parts.iter().map(|part| part.distance(p)).fold(f32::MAX, f32::min)
            }
        }
    }

    /// Distance of a point on the surface to the nearest line of a model of wire (m): edges, and three circles of a ball.
    pub(super) fn wire_distance(&self, point: Vec3) -> f32 {
        let p = self.local(point);
        match self.shape {
            Shape::Plane | Shape::Compound(_) => f32::INFINITY,
            Shape::Cuboid { .. } => self.edge_distance(point),
            Shape::Sphere { .. } => p.abs().min_element(),
            Shape::Capsule { half_height, .. } => {
                p.x.abs().min(p.z.abs()).min((p.y - half_height).abs()).min((p.y + half_height).abs())
            }
            Shape::Hull { planes, .. } => {
                // The nearest face is that of the point; the next one is where an edge is.
                let (mut first, mut second) = (f32::INFINITY, f32::INFINITY);
                for (normal, offset) in planes {
                    let gap = (offset - normal.dot(p)).abs();
                    second = second.min(gap.max(first));
                    first = first.min(gap);
                }
                second
            }
        }
    }

    /// Distance of a point on the surface to the nearest edge of the shape (m): only cuboids have drawn edges.
    pub(super) fn edge_distance(&self, point: Vec3) -> f32 {
        let Shape::Cuboid { half_extents } = self.shape else {
            return f32::INFINITY;
        };
        let inside = (*half_extents - self.local(point).abs()).max(Vec3::ZERO).to_array();
        // The smallest of the three belongs to the face of the point; the next one is the distance to an edge.
        let [a, b, c] = inside;
        a.max(b).min(a.max(c)).min(b.max(c))
    }
}

fn plane(o: Vec3, d: Vec3) -> Option<Span> {
    // Visible from its outer side only: a wall between the eye and the scene would hide everything.
    (o.y > 0.0 && d.y < 0.0).then(|| Span {
        enter: -o.y / d.y,
        exit: f32::INFINITY,
        normal: Vec3::Y,
        exit_normal: Vec3::NEG_Y,
    })
}

fn ball(o: Vec3, d: Vec3, radius: f32) -> Option<Span> {
    let a = d.length_squared();
    let b = -o.dot(d);
    // The cross product keeps digits that b * b - a * c would lose for a small ball far away.
    let discriminant = a * radius * radius - o.cross(d).length_squared();
    if discriminant <= 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    let (enter, exit) = ((b - root) / a, (b + root) / a);
    Some(Span { enter, exit, normal: (o + d * enter) / radius, exit_normal: (o + d * exit) / radius })
}

fn cuboid(o: Vec3, d: Vec3, half: Vec3) -> Option<Span> {
    let mut span = Span { enter: f32::MIN, exit: f32::MAX, normal: Vec3::ZERO, exit_normal: Vec3::ZERO };
    for axis in 0..3 {
        let outward = Vec3::AXES[axis];
        clip(&mut span, outward, half[axis], o, d)?;
        clip(&mut span, -outward, half[axis], o, d)?;
    }
    Some(span)
}

fn hull(o: Vec3, d: Vec3, planes: &[(Vec3, f32)]) -> Option<Span> {
    let mut span = Span { enter: f32::MIN, exit: f32::MAX, normal: Vec3::ZERO, exit_normal: Vec3::ZERO };
    for &(normal, offset) in planes {
        clip(&mut span, normal, offset, o, d)?;
    }
    (span.enter > f32::MIN && span.exit < f32::MAX).then_some(span)
}

/// From where a ray first enters a part to where it leaves that and all that overlap it. That is the wall of a cup, not its hollow.
fn union(o: Vec3, d: Vec3, compound: &Compound) -> Option<Span> {
    let parts = compound.parts.iter();
    let spans =
        parts.filter_map(|part| hull(o - part.centre, d, part.planes()).filter(|span| span.enter > 0.0));
    let mut spans: Vec<Span> = spans.collect();
    spans.sort_by(|a, b| a.enter.total_cmp(&b.enter));
    spans.into_iter().reduce(|a, b| {
        let goes_on = b.enter <= a.exit && b.exit > a.exit;
        if goes_on { Span { exit: b.exit, exit_normal: b.exit_normal, ..a } } else { a }
    })
}

/// Clips a span at the half-space `normal . x <= offset`.
fn clip(span: &mut Span, normal: Vec3, offset: f32, o: Vec3, d: Vec3) -> Option<()> {
    let (slope, gap) = (normal.dot(d), offset - normal.dot(o));
    if slope < 0.0 {
        let t = gap / slope;
        if t > span.enter {
            (span.enter, span.normal) = (t, normal);
        }
    } else if slope > 0.0 {
        let t = gap / slope;
        if t < span.exit {
            (span.exit, span.exit_normal) = (t, normal);
        }
    } else if gap < 0.0 {
        return None;
    }
    (span.enter < span.exit).then_some(())
}

fn capsule(o: Vec3, d: Vec3, half_height: f32, radius: f32) -> Option<Span> {
    let mut best: Option<Span> = None;
    let mut keep = |span: Span| {
        best = Some(match best {
            None => span,
            Some(old) => {
                let first = if span.enter < old.enter { span } else { old };
                let last = if span.exit > old.exit { span } else { old };
                Span { exit: last.exit, exit_normal: last.exit_normal, ..first }
            }
        });
    };
    for end in [half_height, -half_height] {
        if let Some(span) = ball(o - Vec3::Y * end, d, radius) {
            keep(span);
        }
    }
    // Between the caps: the formula of the ball in the plane across the axis.
    let flat = Vec3::new(1.0, 0.0, 1.0);
    if (d.x != 0.0 || d.z != 0.0)
        && let Some(span) = ball(o * flat, d * flat, radius)
    {
        {
            let within = |t: f32| (o.y + d.y * t).abs() <= half_height;
            match (within(span.enter), within(span.exit)) {
                (true, true) => keep(span),
                (true, false) => keep(Span { exit: span.enter, exit_normal: span.normal, ..span }),
                (false, true) => keep(Span { enter: span.exit, normal: span.exit_normal, ..span }),
                (false, false) => {}
            }
        }
    }
    best
}
