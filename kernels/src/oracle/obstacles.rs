//! Swept contact of particles with bodies, and friction at walls, one by one.

use glam::{DVec3, Vec3};

use super::{keep, row, shapes, vector};
use crate::{
    body::{Body, Piece, Shape, Wrench},
    columns::{Columns, lane},
    params::{Params, Retention},
    sweep,
};

/// Wrenches of previous kernels on every body.
pub(super) fn given(wrenches: &[Wrench], bodies: usize) -> Vec<Wrench> {
    let mut total = vec![Wrench::default(); bodies];
    for chunk in wrenches.chunks(bodies.max(1)) {
        for (wrench, part) in total.iter_mut().zip(chunk) {
            wrench.impulse += part.impulse;
            wrench.angular_impulse += part.angular_impulse;
        }
    }
    total
}

/// A position in the frame of one body, transferred to that of the other.
fn carried(from: &Body, to: &Body, point: DVec3) -> DVec3 {
    let local = shapes::rotation(from).transpose() * (point - from.state.position.as_dvec3());
    shapes::rotation(to) * local + to.state.position.as_dvec3()
}

/// Follows a path to a body that stands still. The result is the distance at its end, the distance of the end of the path from the plane
/// there less that, and the normal.
pub(super) fn met(body: &Body, margin: f64, from: DVec3, to: DVec3) -> (f64, f64, DVec3) {
    let length = (to - from).length();
    let (mut gone, mut at) = (0.0, from);
    let look = |at| {
        let (distance, normal) = shapes::distance(body, at);
        (distance - margin, normal)
    };
    let (mut distance, mut normal) = look(from);
    for _ in 0..sweep::ADVANCES {
        if distance <= f64::from(sweep::SWEEP_TOLERANCE) * length || gone + distance >= length {
            break;
        }
        gone += distance;
        at = from + (to - from) * (gone / length);
        (distance, normal) = look(at);
    }
    (distance, (to - at).dot(normal), normal)
}

/// Correction of the end of a path inside a body, in the frame of the body at the beginning.
fn correction([before, after]: [&Body; 2], margin: f64, from: DVec3, to: DVec3) -> DVec3 {
    let (distance, beyond, normal) = met(before, margin, from, carried(after, before, to));
    let beyond = (distance.max(0.0) + beyond).min(0.0);
    let turned = shapes::rotation(after) * shapes::rotation(before).transpose() * normal;
    turned * -beyond
}

/// The convex pieces of bodies as bodies of their own, with the numbers of those.
pub(super) fn convex(bodies: &[Body]) -> Vec<(usize, Body)> {
    let of = |piece: Piece<'_>| {
        let mut body = bodies[piece.body].clone();
        body.shape = piece.shape.into_owned();
        body.state.position += piece.centre.map_or(Vec3::ZERO, |centre| body.state.rotation * centre);
        (piece.body, body)
    };
    Piece::of_all(bodies).map(of).collect()
}

/// The part of a shift that does not lead into the parts of a compound that are nearer than some distance.
pub(super) fn beside_parts(
    (bodies, index): (&[Body], usize),
    x: DVec3,
    mut shift: DVec3,
    nearest: f64,
) -> DVec3 {
    if !matches!(bodies[index].shape, Shape::Compound(_)) {
        return shift;
    }
    let pieces = convex(bodies);
    for is_again in [false, true] {
        for (_, piece) in pieces.iter().filter(|(of, _)| *of == index) {
            let (distance, normal) = shapes::distance(piece, x);
            let into = shift.dot(normal);
            if distance < nearest && into < 0.0 {
                shift = if is_again { DVec3::ZERO } else { shift - into * normal };
            }
        }
    }
    shift
}

/// A convex piece before and after the step, with the number of its body and the radius of the ball that sweeps it.
struct Swept {
    pair: [Body; 2],
    body: usize,
    radius: f64,
}

/// The pieces of all bodies.
fn pieces(params: &Params, bodies: &[Body]) -> Vec<Swept> {
    let swept = |piece: &Piece<'_>| {
        let whole = &bodies[piece.body];
        let pair = [whole.clone(), whole.at_end(params.step)].map(|mut body| {
            body.shape = piece.shape.clone().into_owned();
            body.state.position += piece.centre.map_or(Vec3::ZERO, |centre| body.state.rotation * centre);
            body
        });
        Swept { pair, body: piece.body, radius: f64::from(piece.radius) }
    };
    crate::sph::sweep::obstacles(params, bodies).iter().map(swept).collect()
}

pub(crate) fn sweep_fluid(params: &Params, columns: &mut Columns) {
    let bodies = &columns.bodies.states.0;
    let pieces = pieces(params, bodies);
    let mut wrenches = given(&columns.bodies.fluid_wrenches.0, bodies.len());
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    let spacing = f64::from(params.fluid.spacing);
    for i in 0..columns.rows.fluid {
        let x = vector(columns.fluid.position[i]);
        let mut v = vector(columns.fluid.velocity[i]);
        for Swept { pair, body, radius } in &pieces {
            let moved = correction(pair.each_ref(), 0.05 * spacing + radius, x, x + h * v);
            v += moved / h;
            let centre = bodies[*body].at_end(params.step).state.position.as_dvec3();
            wrenches[*body].add(-mass * moved / h, x + h * v - centre);
        }
        for (index, body) in bodies.iter().enumerate() {
            let parts = pieces.iter().filter(|piece| piece.body == index);
            let deepest = parts.map(|Swept { pair, radius, .. }| {
                correction(pair.each_ref(), 0.05 * spacing + radius, x, x + h * v).length()
            });
            let is_compound = matches!(body.shape, Shape::Compound(_));
            if is_compound && deepest.fold(0.0, f64::max) > 2e-5 * spacing {
                let end = body.at_end(params.step);
                let carried = carried(body, &end, x);
                wrenches[index]
                    .add(-mass * (carried - x - h * v) / h, carried - end.state.position.as_dvec3());
                v = (carried - x) / h;
            }
        }
        columns.fluid.velocity[i] = keep(columns.fluid.velocity[i], v);
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

/// Integral of `lap W z / y` over a half-space at the distance y, for the viscosity function, slice by slice.
pub(super) fn half_space(radius: f64, distance: f64) -> f64 {
    const SLICES: usize = 4000;
    let y = distance.max(radius / 8.0);
    let thickness = (radius - y).max(0.0) / SLICES as f64;
    let slice = |k: usize| {
        let z = y + (k as f64 + 0.5) * thickness;
        // 2 pi int r lap W dr from z to H, with lap W = 45 / (pi H^5) (1 - r / H).
        let ring = (radius * radius - z * z) / 2.0 - (radius.powi(3) - z.powi(3)) / (3.0 * radius);
        90.0 / radius.powi(5) * ring * z / y * thickness
    };
    (0..SLICES).map(slice).sum()
}

pub(crate) fn wall_friction(params: &Params, columns: &mut Columns) {
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let mut wrenches = given(&columns.bodies.fluid_wrenches.0, bodies.len());
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    let radius = f64::from(params.fluid.smoothing.support_radius);
    let kinematic = f64::from(params.fluid.wall_viscosity) / f64::from(params.fluid.rest_density);
    let slowed = |distance: f64, slide: DVec3, normal: DVec3| {
        let rate = if distance < radius { kinematic * half_space(radius, distance) } else { 0.0 };
        (slide - normal * slide.dot(normal)) * rate.min(1.0 / h)
    };
    for i in 0..columns.rows.fluid {
        let (x, v) = (vector(fluid.position[i]), vector(fluid.velocity[i]));
        let mut sum = DVec3::ZERO;
        if let Some((low, high)) = params.walls.filter(|_| params.no_slip) {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                sum += slowed((x - low.as_dvec3()).dot(axis), v, axis);
                sum += slowed((high.as_dvec3() - x).dot(axis), v, axis);
            }
        }
        for (body, wrench) in bodies.iter().zip(&mut wrenches).filter(|(body, _)| body.no_slip) {
            let (distance, normal) = shapes::distance(body, x);
            let own = slowed(distance, v - shapes::velocity(body, x), normal);
            sum += own;
            wrench.add(own * (mass * h), x - body.state.position.as_dvec3());
        }
        let allowed = f64::from(fluid.acceleration[i][lane::fluid::acceleration::ALLOWED_COMPRESSION]);
        fluid.acceleration[i] = row(vector(fluid.acceleration[i]) - sum, allowed);
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}

pub(crate) fn retention(params: &Params, columns: &mut Columns) {
    let Some(Retention { strength, density, range }) = params.fluid.retention else { return };
    let (fluid, bodies) = (&mut columns.fluid, &columns.bodies.states.0);
    let mut wrenches = given(&columns.bodies.fluid_wrenches.0, bodies.len());
    let (h, mass) = (f64::from(params.step), f64::from(params.fluid.particle_mass));
    for i in 0..columns.rows.fluid {
        let lack = f64::from(density) - f64::from(fluid.density[i]);
        if lack <= 0.0 || fluid.moment[i][lane::fluid::moment::MATERIAL] > 0.02 {
            continue;
        }
        let most = h * f64::from(strength) * lack;
        let slowed = |distance: f64, relative: DVec3, normal: DVec3| {
            let slide = relative - normal * relative.dot(normal);
            if distance < f64::from(range) { slide.clamp_length_max(most) } else { DVec3::ZERO }
        };
        let (x, mut v) = (vector(fluid.position[i]), vector(fluid.velocity[i]));
        if let Some((low, high)) = params.walls {
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                v -= slowed((x - low.as_dvec3()).dot(axis), v, axis);
                v -= slowed((high.as_dvec3() - x).dot(axis), v, axis);
            }
        }
        for (body, wrench) in bodies.iter().zip(&mut wrenches) {
            let (distance, normal) = shapes::distance(body, x);
            let taken = slowed(distance, v - shapes::velocity(body, x), normal);
            v -= taken;
            wrench.add(taken * mass, x - body.state.position.as_dvec3());
        }
        fluid.velocity[i] = row(v, f64::from(fluid.velocity[i][3]));
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
}
