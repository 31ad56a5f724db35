//! Contact of a node with walls and bodies, in its quadratic energy.
//!
//! A node at x with stiffness H lies `depth` below a surface with normal n. A force r pushes it to the minimum of its energy
//! on the surface. The surface is the first one on its path through the step (`sweep.rs`), in the frame of the body:
//!
//! ```text
//! dx = H^-1 r,   n . dx = depth
//! ```
//!
//! It sticks if the force to the point of sticking, `r = H (depth n - slide)`, lies in the cone of Coulomb friction,
//! `|r_t| <= mu r_n`. Otherwise it slips, and `r = l (n + mu r_t / |r_t|)`.

use glam::{DVec3, Vec3};

use crate::{
    body::{Body, BodyState, Piece, Placed, Wrench},
    cpu::Cpu,
    lanes::{self, LANES, Simd, f32x8, prelude::*, select, with_lanes},
    layout::constants,
    params::Params,
    pbd::descent::{Material, Symmetric, product},
    sweep::met,
    vector::{Vec3x8, dot, minus, plus, splat, times},
};

constants! {
    /// Distance that nodes keep from bodies, in edges: what lies on the floor does not slip under a body that stands on it.
    pub(super) const CLEARANCE: f32 = 1.0e-3;
    /// Smallest part of the compliance along the normal that friction may leave.
    const MINIMUM_COMPLIANCE: f32 = 0.1;
    /// How close to an obstacle, in edges, a node is looked at.
    pub(super) const OBSTACLE_MARGIN: f32 = 1.0e-2;
}

/// What is left of the distance of a node from a body after rounding, at least \[1\].
const SPARE: f32 = 0.999;

/// Eight values of each coordinate.
type Lanes3 = [[f32; LANES]; 3];

/// Obstacles of nodes.
///
/// Its functions are compiled separately, with arrays at their interface. Few nodes touch anything, and inlining the code of
/// all shapes into the solver takes the compiler minutes.
#[derive(Debug)]
pub(super) struct Obstacles<'a> {
    cpu: &'a Cpu,
    step: f32,
    /// Axis, direction of the normal along it, and position of every wall.
    walls: Vec<(usize, f32, f32)>,
    bodies: &'a [Body],
    spheres: Vec<Sphere>,
    pieces: Vec<Piece<'a>>,
}

/// Region that a body may reach within a step.
#[derive(Clone, Copy, Debug)]
struct Sphere {
    centre: Vec3,
    /// Radius of the body and the path of its centre; infinite for planes \[m\].
    radius: f32,
    /// Angle by which it rotates.
    turn: f32,
}

impl Sphere {
    fn of(body: &Body, step: f32) -> Self {
        let BodyState { position, linear_velocity, angular_velocity, .. } = body.state;
        let radius = body.shape.bounding_radius() + step * linear_velocity.length();
        Self { centre: position, radius, turn: step * angular_velocity.length() }
    }

    /// Whether none of eight nodes can have come closer than `margin` to the body on the path from `old`.
    #[inline(always)]
    fn is_far<S: Simd>(&self, simd: S, [point, old]: [Vec3x8<S>; 2], margin: f32x8<S>) -> bool {
        let (way, away) = (minus(point, old), minus(old, splat(simd, self.centre.to_array())));
        // In the frame of the body its rotation adds to the path of a node, in proportion to the distance.
        let nearest = dot(away, away).sqrt() * (SPARE - self.turn) - dot(way, way).sqrt() * (1.0 + self.turn);
        nearest.simd_gt(margin + self.radius).all_true()
    }
}

/// Eight nodes in their quadratic energies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// Positions of the nodes.
    pub(super) point: Lanes3,
    /// Positions at the beginning of the step.
    pub(super) old: Lanes3,
    /// Second derivative of the energy, with inertia.
    pub(super) stiffness: [[f32; LANES]; 6],
    /// Its inverse.
    pub(super) inverse: [[f32; LANES]; 6],
    /// Coulomb friction against walls.
    pub(super) friction: [f32; LANES],
    /// 1 for nodes that obstacles may move, else 0.
    pub(super) own: [f32; LANES],
    /// Clearance from bodies \[m\].
    pub(super) clearance: [f32; LANES],
}

impl<'a> Obstacles<'a> {
    pub(super) fn new(cpu: &'a Cpu, params: &Params, bodies: &'a [Body]) -> Self {
        let spheres = bodies.iter().map(|body| Sphere::of(body, params.step)).collect();
        let pieces = Piece::of_all(bodies).collect();
        let walls = params.walls.map_or_else(Vec::new, walls);
        Self { cpu, step: params.step, walls, bodies, spheres, pieces }
    }

    /// 1 for points that may have come closer than `margin` to an obstacle on the path from `old`, else 0.
    #[inline(never)]
    pub(super) fn near(&self, point: &Lanes3, old: &Lanes3, margin: &[f32; LANES]) -> [f32; LANES] {
        with_lanes!(self.cpu, simd => self.near_lanes(simd, [point, old], margin))
    }

    #[inline(always)]
    fn near_lanes<S: Simd>(
        &self,
        simd: S,
        [point, old]: [&Lanes3; 2],
        margin: &[f32; LANES],
    ) -> [f32; LANES] {
        let (point, old) = (vector(simd, point), vector(simd, old));
        let margin = lanes::load_array(simd, margin);
        let one = lanes::splat(simd, 1.0);
        let mut near = lanes::splat(simd, 0.0);
        for (axis, sign, wall) in &self.walls {
            near = select(((point[*axis] - *wall) * *sign).simd_lt(margin), one, near);
        }
        let bodies = self.bodies.iter().zip(&self.spheres).filter(|(body, _)| body.touches_nodes);
        for (body, sphere) in bodies {
            if sphere.is_far(simd, [point, old], margin) {
                continue;
            }
            let placed = Placed::new(simd, body);
            let drift = times(placed.velocity(point), lanes::splat(simd, self.step));
            let way = minus(minus(point, drift), old);
            let length = dot(way, way).sqrt();
            near = select((placed.distance(old).0 - length).simd_lt(margin), one, near);
        }
        near.to_array()
    }

    /// Moves the nodes out of all obstacles, and returns the forces on them. Adds the impulses on bodies to `wrenches`, with
    /// the positions at the beginning of the step as the points of attack.
    #[inline(never)]
    pub(super) fn push(&self, contact: &mut Contact, wrenches: Option<&mut [Wrench]>) -> Lanes3 {
        with_lanes!(self.cpu, simd => self.push_lanes(simd, contact, wrenches))
    }

    #[inline(always)]
    fn push_lanes<S: Simd>(
        &self,
        simd: S,
        contact: &mut Contact,
        mut wrenches: Option<&mut [Wrench]>,
    ) -> Lanes3 {
        let zero = lanes::splat(simd, 0.0);
        let own = lanes::load_array(simd, &contact.own);
        let clearance = lanes::load_array(simd, &contact.clearance);
        let quadratic = Quadratic::load(simd, contact);
        let old = vector(simd, &contact.old);
        let mut point = vector(simd, &contact.point);
        let mut total = [zero; 3];
        // A node that sticks to the floor must not resist a plate: bodies come after the walls. A node that they push into a
        // wall slides along it.
        let walls = self.walls.len();
        for index in 0..2 * walls + self.pieces.len() {
            let is_again = index >= walls + self.pieces.len();
            let piece = index.checked_sub(walls).filter(|_| !is_again).map(|index| &self.pieces[index]);
            let body = piece.map(|piece| piece.body);
            let mut drift = [zero; 3];
            let (distance, normal, friction);
            if let Some(piece) = piece {
                let (body, sphere) = (&self.bodies[piece.body], &self.spheres[piece.body]);
                if !body.touches_nodes || sphere.is_far(simd, [point, old], clearance) {
                    continue;
                }
                let placed = Placed::of_piece(simd, body, piece.geometry());
                drift = times(placed.velocity(point), lanes::splat(simd, self.step));
                // The body is at its place of the beginning of the step: so is the node, in the body's frame.
                let way = [placed.local(old), placed.local(minus(point, drift))];
                let met = met(simd, &placed, way, clearance);
                (distance, normal) = (met.distance + met.beyond, placed.turned(met.normal));
                friction = lanes::splat(simd, body.friction);
            } else {
                let (axis, sign, wall) = self.walls[index % (walls + self.pieces.len())];
                distance = (point[axis] - wall) * sign;
                let mut along = [zero; 3];
                along[axis] = lanes::splat(simd, sign);
                normal = along;
                friction = if is_again { zero } else { lanes::load_array(simd, &contact.friction) };
            }
            let depth = lanes::positive(simd, -distance) * own;
            if !depth.simd_gt(zero).any_true() {
                continue;
            }
            let slide = minus(minus(point, old), drift);
            let (change, force) = react(simd, &quadratic, depth, normal, slide, friction);
            point = plus(point, change);
            total = plus(total, force);
            if let (Some(wrenches), Some(body)) = (wrenches.as_deref_mut(), body) {
                let centre = self.bodies[body].state.position;
                give(&array(force), &contact.old, (self.step, centre), &mut wrenches[body]);
            }
        }
        // One obstacle may push a node into another: walls come last.
        for (axis, sign, wall) in &self.walls {
            let outside = ((point[*axis] - *wall) * *sign).simd_lt(zero) & own.simd_gt(zero);
            point[*axis] = select(outside, lanes::splat(simd, *wall), point[*axis]);
        }
        contact.point = array(point);
        array(total)
    }
}

#[inline(always)]
pub(super) fn vector<S: Simd>(simd: S, of: &Lanes3) -> Vec3x8<S> {
    [lanes::load_array(simd, &of[0]), lanes::load_array(simd, &of[1]), lanes::load_array(simd, &of[2])]
}

#[inline(always)]
pub(super) fn array<S: Simd>(of: Vec3x8<S>) -> Lanes3 {
    [of[0].to_array(), of[1].to_array(), of[2].to_array()]
}

/// Stiffness of eight nodes with their inertia, and its inverse.
pub(super) struct Quadratic<S: Simd> {
    pub(super) stiffness: Symmetric<S>,
    pub(super) inverse: Symmetric<S>,
}

impl<S: Simd> Quadratic<S> {
    #[inline(always)]
    fn load(simd: S, contact: &Contact) -> Self {
        let zero = lanes::splat(simd, 0.0);
        let mut loaded = Self { stiffness: [zero; 6], inverse: [zero; 6] };
        for k in 0..6 {
            loaded.stiffness[k] = lanes::load_array(simd, &contact.stiffness[k]);
            loaded.inverse[k] = lanes::load_array(simd, &contact.inverse[k]);
        }
        loaded
    }

    /// Nodes at `point` in this energy.
    #[inline(always)]
    pub(super) fn contact(
        &self,
        (point, old): (Vec3x8<S>, Vec3x8<S>),
        material: &Material<S>,
        own: f32x8<S>,
    ) -> Contact {
        let mut contact = Contact {
            point: array(point),
            old: array(old),
            stiffness: [[0.0; LANES]; 6],
            inverse: [[0.0; LANES]; 6],
            friction: material.friction.to_array(),
            own: own.to_array(),
            clearance: (material.edge * CLEARANCE).to_array(),
        };
        for k in 0..6 {
            contact.stiffness[k] = self.stiffness[k].to_array();
            contact.inverse[k] = self.inverse[k].to_array();
        }
        contact
    }
}

/// Adds the opposite of the impulses of eight forces to a wrench.
#[inline(never)]
fn give(force: &Lanes3, old: &Lanes3, (step, centre): (f32, Vec3), wrench: &mut Wrench) {
    for lane in 0..LANES {
        let vector =
            |of: &Lanes3| DVec3::new(f64::from(of[0][lane]), f64::from(of[1][lane]), f64::from(of[2][lane]));
        let force = vector(force);
        if force != DVec3::ZERO {
            wrench.add(force * -f64::from(step), vector(old) - centre.as_dvec3());
        }
    }
}

/// The six walls of a box.
fn walls((minimum, maximum): (Vec3, Vec3)) -> Vec<(usize, f32, f32)> {
    (0..3).flat_map(|axis| [(axis, 1.0, minimum[axis]), (axis, -1.0, maximum[axis])]).collect()
}

/// Change of position and force; both are zero where `depth` is.
#[inline(always)]
fn react<S: Simd>(
    simd: S,
    quadratic: &Quadratic<S>,
    depth: f32x8<S>,
    normal: Vec3x8<S>,
    slide: Vec3x8<S>,
    friction: f32x8<S>,
) -> (Vec3x8<S>, Vec3x8<S>) {
    let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
    let tangential = minus(slide, times(normal, dot(slide, normal)));
    let back = minus(times(normal, depth), tangential);
    let stuck = product(&quadratic.stiffness, back);
    let across = dot(stuck, normal);
    let along = minus(stuck, times(normal, across));
    let length = dot(along, along).sqrt();
    // Weights instead of selections: the scalar fallback branches at every selection of every lane.
    let sticks = select(length.simd_le(across * friction), one, zero);
    let slips = one - sticks;
    let scale = friction / select(length.simd_gt(zero), length, one);
    let slanted = plus(normal, times(along, scale));
    let (by_slanted, by_normal) = (product(&quadratic.inverse, slanted), product(&quadratic.inverse, normal));
    let (with, without) = (dot(normal, by_slanted), dot(normal, by_normal));
    let tilted = select(with.simd_gt(without * MINIMUM_COMPLIANCE), one, zero);
    let plain = one - tilted;
    let direction = plus(times(slanted, tilted), times(normal, plain));
    let compliance = plus(times(by_slanted, tilted), times(by_normal, plain));
    let size = depth / (with * tilted + without * plain) * slips;
    let touches = select(depth.simd_gt(zero), one, zero);
    let change = plus(times(back, sticks), times(compliance, size));
    let force = plus(times(stuck, sticks), times(direction, size));
    (times(change, touches), times(force, touches))
}
