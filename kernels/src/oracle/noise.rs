//! Damping of velocities that differ from particle to particle, pair by pair.

use glam::DVec3;

use super::{
    divergence::{Other, pairs_of},
    images::{Seen, Twist, reflected, seen, store_images},
    keep, row, vector, vectors,
};
use crate::{
    body::Wrench,
    columns::{Columns, Fluid},
    params::Params,
};

/// `sum_j c_ij (v_j - v_i) . x_ij x_ij` over particles and images, and the parts of images in bodies at the particles.
fn closing(
    params: &Params,
    fluid: &Fluid,
    images: &[Seen],
    (v, of_images): (&[DVec3], &[DVec3]),
) -> (Vec<DVec3>, Vec<(usize, usize, DVec3)>) {
    let x = vectors(&fluid.position, v.len());
    let (mut sums, mut of_bodies) = (Vec::new(), Vec::new());
    for i in 0..v.len() {
        let mut sum = DVec3::ZERO;
        for (offset, c, other) in pairs_of(params, &x, images, i) {
            let value = match other {
                Other::Particle(j) => v[j],
                Other::Image(j) => of_images[j],
            };
            let part = offset * (c * (value - v[i]).dot(offset));
            sum += part;
            if let Other::Image(j) = other
                && let Some(body) = images[j].body
            {
                of_bodies.push((i, body, part));
            }
        }
        sums.push(sum);
    }
    (sums, of_bodies)
}

pub(crate) fn approach(params: &Params, columns: &mut Columns) {
    let Some(solve) = params.fluid.divergence() else { return };
    let (fluid, count, bodies) = (&mut columns.fluid, columns.rows.fluid, &columns.bodies.states.0);
    let images = seen(&fluid.images);
    let v = vectors(&fluid.velocity, count);
    let twists: Vec<Twist> = bodies
        .iter()
        .map(|body| (body.state.linear_velocity.as_dvec3(), body.state.angular_velocity.as_dvec3()))
        .collect();
    let of_images = reflected(fluid, &images, &v, bodies, &twists);
    let (sums, _) = closing(params, fluid, &images, (&v, &of_images));
    fluid.approach.resize(fluid.position.len(), [0.0; 4]);
    for (own, sum) in fluid.approach.iter_mut().zip(sums) {
        *own = row(sum / f64::from(solve.lattice_moment), 0.0);
    }
    store_images(&mut fluid.image_vectors.0, fluid.images.position.len(), &of_images);
}

pub(crate) fn damping(params: &Params, columns: &mut Columns) {
    let Some(solve) = params.fluid.divergence() else { return };
    let (fluid, count, bodies) = (&mut columns.fluid, columns.rows.fluid, &columns.bodies.states.0);
    let images = seen(&fluid.images);
    let v = vectors(&fluid.approach, count);
    let of_images = reflected(fluid, &images, &v, bodies, &vec![Twist::default(); bodies.len()]);
    let (sums, of_bodies) = closing(params, fluid, &images, (&v, &of_images));
    let (step, speed) = (f64::from(params.step), f64::from(fluid.pressure_solve.speed()));
    let part = (0.25 * step * speed / f64::from(params.fluid.spacing)).min(0.3);
    let rate = part / (step * f64::from(solve.lattice_moment));
    for (own, sum) in fluid.acceleration.iter_mut().zip(sums) {
        *own = keep(*own, vector(*own) - sum * rate);
    }
    let store = &columns.bodies.fluid_wrenches;
    let mut wrenches: Vec<Wrench> = (0..bodies.len()).map(|body| store.total(body, bodies.len())).collect();
    for (i, body, part) in of_bodies {
        let impulse = part * (f64::from(params.fluid.particle_mass) * step * rate);
        wrenches[body].add(impulse, vector(fluid.position[i]) - bodies[body].state.position.as_dvec3());
    }
    columns.bodies.fluid_wrenches.0 = wrenches;
    store_images(&mut fluid.image_vectors.0, fluid.images.position.len(), &of_images);
}
