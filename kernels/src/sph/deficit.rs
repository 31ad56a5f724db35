//! Deficit of neighbours of particles near the surface of the fluid, within twice the support radius.
//!
//! ```text
//! e_i = max(0, 1.03 - s_i),   s_i = (0.05 + sum_j V W_ij) / phi_i,   phi_i = prod_k (1 - lambda_ik)
//! w_i = e_i (1 - 2.5 e_i), and 0.01 beyond where it has fallen to that
//! ```
//!
//! with a smoothing function of its own. `lambda_ik` is the part of it that lies in a wall or body k: `u^6 (3.5 - 4.5 u + 1.5 u^2)` at
//! the distance y of a plane, with u = 1 - y / H. What they leave, `phi_i`, is all that water could fill. A surface that meets a wall
//! at a right angle therefore has the deficits of one that goes on beyond it. The noise of particles deep inside stays below two per
//! cent. Walls add three per cent of their part, because layers beside them are less even.
//!
//! The kernel writes `w_i / phi_i`, with w the derivative of the energy density of `sph::cohesion` by the deficit. For `sph::adhesion`
//! it writes `w_i s_i`. With w = e the layers below a surface attract each other much more strongly than the surface contracts. With
//! this w the energy hardly depends on their distance, so that it is that of the surface alone (docs/pressure-solve.md).

use crate::{
    body::Body,
    columns::{Columns, Fluid},
    cpu::Cpu,
    grid::neighbors::ChunkLists,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, select},
    params::{Cohesion, Params},
    periodic::{Space, with_space},
    smoothing::Wendland,
    vector::dot,
};

use super::obstacles::{Profile, near};

declare! {
    needs: [Fluid, Cohesion],
    reads: [FluidPosition, FluidNeighbors, BodyStates],
    writes: [FluidDeficit, FluidAdhesion],
    oracle: crate::oracle::surface::deficit,
    // Weights of deficits are a tenth of the sums whose differences they are.
    bound: 4e-5,
    twin: [pass(NAME, Fluid)],
    constants: {
        /// Share of the neighbourhood that may lack by noise, away from walls.
        pub(crate) const NOISE_SHARE: f32 = 0.02;
        /// The same beside walls and bodies, over their part of the neighbourhood.
        const WALL_NOISE_SHARE: f32 = 0.03;
        /// How fast the weight of a deficit falls. With 2.4 the layers below a flat surface pull together least in the continuum. 2.5
        /// spreads the periods of drops least.
        const DEFICIT_FALL: f64 = 2.5;
        /// Weight of what lacks nearly everything, such as a particle alone: positive, so that it is drawn to others.
        const MINIMUM_DEFICIT_WEIGHT: f64 = 0.01;
    },
}

/// Weight of a deficit: the derivative of `energy`.
#[must_use]
pub fn weight(deficit: f64) -> f64 {
    let falling = deficit * (1.0 - DEFICIT_FALL * deficit);
    if deficit > 0.5 / DEFICIT_FALL { falling.max(MINIMUM_DEFICIT_WEIGHT) } else { falling }
}

/// Energy density of a deficit over the stiffness \[1\].
fn energy(deficit: f64) -> f64 {
    // Where the weight has fallen to the least.
    let end = (1.0 + (1.0 - 4.0 * DEFICIT_FALL * MINIMUM_DEFICIT_WEIGHT).sqrt()) / (2.0 * DEFICIT_FALL);
    let e = deficit.min(end);
    e * e * (0.5 - DEFICIT_FALL / 3.0 * e) + MINIMUM_DEFICIT_WEIGHT * (deficit - e)
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Some(cohesion) = &params.fluid.cohesion else { return };
    let count = columns.rows.fluid;
    let Fluid { position, neighbors, deficit, adhesion, .. } = &mut columns.fluid;
    deficit.resize(position.len(), 0.0);
    adhesion.resize(position.len(), 0.0);
    let task = Task { params, cohesion, position, bodies: &columns.bodies.states.0 };
    cpu.for_chunks((&mut deficit[..], &mut adhesion[..]), |first, (deficit, adhesion)| {
        let lists = neighbors.chunk(first);
        let rows = (&mut *deficit, &mut *adhesion);
        with_space!(cpu, params, simd, space => task.chunk((simd, space), first, lists, rows));
        // Padding rows are no surface.
        let used = count.saturating_sub(first).min(deficit.len());
        deficit[used..].fill(0.0);
        adhesion[used..].fill(0.0);
    });
}

struct Task<'a> {
    params: &'a Params,
    cohesion: &'a Cohesion,
    position: &'a [[f32; 4]],
    bodies: &'a [Body],
}

impl Task<'_> {
    #[inline(always)]
    fn chunk<S: Simd>(
        &self,
        (simd, space): (S, impl Space<S>),
        first: usize,
        lists: &ChunkLists,
        (deficit, adhesion): (&mut [f32], &mut [f32]),
    ) {
        let cohesion = self.cohesion;
        let kernel = cohesion.smoothing.lanes(simd);
        let value = kernel.value_scale() * cohesion.volume;
        let profile = Profile::HalfSpace { radius: cohesion.smoothing.support_radius };
        let near = near(self.bodies, &self.position[first..first + deficit.len()], profile.range());
        for row in (0..deficit.len()).step_by(LANES) {
            let [x, y, z, _] = lanes::load_rows(simd, self.position, first + row);
            let mut sum = lanes::splat(simd, 0.0);
            for entry in lists.group(row) {
                let [xj, yj, zj, _] = lanes::gather_rows(simd, self.position, entry);
                let apart = space.apart([x, y, z], [xj, yj, zj]);
                sum += kernel.shape(kernel.closeness(dot(apart, apart)));
            }
            let [_, _, _, mut share] = profile.walls(simd, self.params, [x, y, z]);
            for body in &near {
                share = profile.both(share, profile.body(simd, &self.bodies[*body], [x, y, z])[3]);
            }
            let open = lanes::splat(simd, 1.0) - share;
            let filled = (sum * value + (NOISE_SHARE + WALL_NOISE_SHARE)) / open;
            let weight =
                weights(simd, lanes::positive(simd, lanes::splat(simd, 1.0 + WALL_NOISE_SHARE) - filled));
            lanes::store(deficit, row, weight / open);
            lanes::store(adhesion, row, weight * filled);
        }
    }
}

/// `weight` in every lane.
#[inline(always)]
fn weights<S: Simd>(simd: S, deficit: f32x8<S>) -> f32x8<S> {
    let falling = deficit * (lanes::splat(simd, 1.0) - deficit * lanes::splat(simd, DEFICIT_FALL as f32));
    let minimum = falling.max(lanes::splat(simd, MINIMUM_DEFICIT_WEIGHT as f32));
    select(deficit.simd_gt(lanes::splat(simd, (0.5 / DEFICIT_FALL) as f32)), minimum, falling)
}

/// Stiffness \[Pa\] with which a lattice that ends in a plane has the surface tension \[N/m\]: energy density over energy of
/// a deficit. `settled` is the energy of a surface that has settled, over that of the lattice.
#[must_use]
pub fn cohesion_stiffness(smoothing: &Wendland, spacing: f32, tension: f32, settled: f64) -> f32 {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32;
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    let mut energies = 0.0;
    for layer in 0..reach {
        // Sum beyond the outermost layer, which is missing.
        let mut missing = 0.0;
        for (x, y, z) in (-reach..=reach)
            .flat_map(|x| (layer + 1..=reach).flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z))))
        {
            let distance = f64::from(x * x + y * y + z * z).sqrt() * d;
            missing += volume * Wendland::value_f64(radius, distance);
        }
        energies += energy((missing - f64::from(NOISE_SHARE)).max(0.0));
    }
    (f64::from(tension) * d * d / (settled * volume * energies)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points over the radius of the energy.
    const POINTS: u32 = 200;

    #[test]
    fn the_weight_is_the_derivative_of_the_energy() {
        for index in 1..98 {
            let e = 0.01 * f64::from(index);
            let slope = (energy(e + 1e-6) - energy(e - 1e-6)) / 2e-6;
            assert!((slope - weight(e)).abs() < 1e-6, "{e}: {slope}, {}", weight(e));
            // Negative control: a square energy.
            assert!((slope - e).abs() > 1e-4, "{e}");
        }
    }

    /// Largest slope of the pressure that a flat surface needs, over tension and squared radius, for an energy and its
    /// derivative: `p(z) = integral f'(e(z')) W(z - z') dz' - f(e(z))`, `integral f(e(z)) dz = 1`.
    fn steepest(energy: fn(f64) -> f64, derivative: fn(f64) -> f64) -> f64 {
        let step = 1.0 / f64::from(POINTS);
        // The smoothing function integrated over planes, and beyond a depth.
        let depths: Vec<f64> = (0..2 * POINTS).map(|index| (f64::from(index) + 0.5) * step).collect();
        let plane = |z: f64| {
            let rings = depths.iter().filter(|r| **r > z.abs());
            rings.map(|r| std::f64::consts::TAU * r * step * Wendland::value_f64(1.0, *r)).sum::<f64>()
        };
        let planes: Vec<f64> = depths.iter().map(|z| plane(*z - 0.5 * step)).collect();
        let mut beyond = 0.0;
        let mut deficits = vec![0.0; depths.len()];
        for (deficit, plane) in deficits.iter_mut().zip(&planes).rev() {
            *deficit = beyond + 0.5 * step * plane;
            beyond += step * plane;
        }
        let tension: f64 = deficits.iter().map(|e| energy(*e) * step).sum();
        let pressure = |z: usize| {
            let pulls = deficits.iter().zip(0_usize..);
            let pull = pulls.map(|(e, other)| derivative(*e) * planes[z.abs_diff(other)] * step);
            (pull.sum::<f64>() - energy(deficits[z])) / tension
        };
        let pressures: Vec<f64> = (0..depths.len()).map(pressure).collect();
        pressures.windows(2).map(|pair| (pair[1] - pair[0]).abs() / step).fold(0.0, f64::max)
    }

    #[test]
    fn layers_below_a_surface_pull_less_than_with_a_square() {
        let square = steepest(|e| 0.5 * e * e, |e| e);
        let weighed = steepest(energy, weight);
        assert!((55.0..70.0).contains(&square), "{square}");
        assert!((20.0..32.0).contains(&weighed), "{weighed}");
    }
}
