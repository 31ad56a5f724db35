//! Walls and bodies near particles: their boundary volume fraction, and the reactions on them.

use glam::DVec3;

use crate::{
    body::{Body, Placed, Wrench, by_chunk},
    column::FAR,
    cpu::CHUNK,
    lanes::{self, Simd, f32x8},
    layout::constants,
    params::{Incompressible, Params},
    smoothing::Wendland,
    vector::{Vec3x8, times},
};

/// The bodies at the end of the step.
pub(super) fn at_end(bodies: &[Body], step: f32) -> Vec<Body> {
    bodies.iter().map(|body| body.at_end(step)).collect()
}

/// Bodies whose bounding sphere comes within `range` of the box of the points.
pub(crate) fn near(bodies: &[Body], points: &[[f32; 4]], range: f32) -> Vec<usize> {
    if bodies.is_empty() {
        return Vec::new();
    }
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for point in points.iter().filter(|point| point[0] < FAR) {
        low = [0, 1, 2].map(|axis| low[axis].min(point[axis]));
        high = [0, 1, 2].map(|axis| high[axis].max(point[axis]));
    }
    let is_near = |body: &Body| {
        let reach = body.shape.reach(range);
        let centre = body.state.position.to_array();
        (0..3).all(|axis| centre[axis] + reach > low[axis] && centre[axis] - reach < high[axis])
    };
    (0..bodies.len()).filter(|body| is_near(&bodies[*body])).collect()
}

constants! {
    /// Depth `1 - y / R` beyond which share and slope do not grow: a particle that a body has swallowed is pushed out, not shot.
    const MAXIMUM_DEPTH: f32 = 1.25;
}

/// The volume fraction of a surface as a function of the distance from it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Profile {
    /// That of the pressure solve, with twice the slope at the first layer (`boundary_profile`).
    Pressure { range: f32, share: f32 },
    /// The part of a smoothing function of that support radius that lies beyond a plane. Several planes leave the product of what each
    /// leaves, as planes at right angles do. The slope is that of the logarithm of what is left.
    HalfSpace { radius: f32 },
}

impl Profile {
    pub(super) fn of(params: &Params) -> Option<Self> {
        let Incompressible { boundary_range: range, boundary_share: share, .. } =
            *params.fluid.incompressible.as_ref()?;
        Some(Self::Pressure { range, share })
    }

    /// Distance from which on there is none.
    pub(super) fn range(self) -> f32 {
        match self {
            Self::Pressure { range, .. } => range,
            Self::HalfSpace { radius } => radius,
        }
    }

    /// Volume fraction, and its slope into the surface, at a distance. Deep inside as at a quarter of the range below the
    /// surface.
    #[inline(always)]
    fn at<S: Simd>(self, simd: S, distance: f32x8<S>) -> (f32x8<S>, f32x8<S>) {
        let splat = |value| lanes::splat(simd, value);
        let depth = lanes::positive(simd, splat(1.0) - distance * (1.0 / self.range()));
        match self {
            Self::Pressure { range, share } => {
                let depth = depth.min(splat(MAXIMUM_DEPTH));
                let square = depth * depth;
                let fifth = square * square * depth;
                (fifth * depth * share, fifth * (6.0 * share / range))
            }
            Self::HalfSpace { radius } => {
                let depth = depth.min(splat(1.0));
                let square = depth * depth;
                let fifth = square * square * depth;
                let share = fifth * depth * (splat(3.5) - depth * 4.5 + square * 1.5);
                let slope = fifth * (splat(21.0) - depth * 31.5 + square * 12.0) * (1.0 / radius);
                (share, slope / (splat(1.0) - share))
            }
        }
    }

    /// Volume fraction of two surfaces together.
    #[inline(always)]
    pub(super) fn both<S: Simd>(self, one: f32x8<S>, other: f32x8<S>) -> f32x8<S> {
        match self {
            Self::Pressure { .. } => one + other,
            Self::HalfSpace { .. } => one + other - one * other,
        }
    }

    /// Gradient and volume fraction of the walls of the container.
    #[inline(always)]
    pub(super) fn walls<S: Simd>(self, simd: S, params: &Params, point: Vec3x8<S>) -> [f32x8<S>; 4] {
        let zero = lanes::splat(simd, 0.0);
        let mut sum = [zero; 4];
        let Some((low, high)) = params.walls else { return sum };
        for axis in 0..3 {
            let (below, falling) = self.at(simd, point[axis] - low[axis]);
            let (above, rising) = self.at(simd, lanes::splat(simd, high[axis]) - point[axis]);
            sum[axis] = rising - falling;
            sum[3] = self.both(self.both(sum[3], below), above);
        }
        sum
    }

    /// Gradient and volume fraction of a body.
    #[inline(always)]
    pub(super) fn body<S: Simd>(self, simd: S, body: &Body, point: Vec3x8<S>) -> [f32x8<S>; 4] {
        let placed = Placed::new(simd, body);
        let (distance, normal) = placed.distance(point);
        let (share, slope) = self.at(simd, distance);
        let [x, y, z] = times(normal, -slope);
        [x, y, z, share]
    }

    /// Adds to a wrench the impulses of particles of the given pressures on a body: `m h P grad lambda` each, at the
    /// particle.
    #[inline(always)]
    pub(super) fn react<S: Simd>(
        self,
        simd: S,
        body: &Body,
        point: Vec3x8<S>,
        momentum: &[f32],
        wrench: &mut Wrench,
    ) {
        let [gx, gy, gz, _] = self.body(simd, body, point);
        let centre = body.state.position.as_dvec3();
        for (lane, momentum) in momentum.iter().enumerate() {
            let gradient = DVec3::new(f64::from(gx[lane]), f64::from(gy[lane]), f64::from(gz[lane]));
            let point =
                DVec3::new(f64::from(point[0][lane]), f64::from(point[1][lane]), f64::from(point[2][lane]));
            wrench.add(gradient * f64::from(*momentum), point - centre);
        }
    }
}

/// Adds vectors of the first `lanes` of eight particles to a wrench, times a scale, at arms from the centre of the body.
#[inline(always)]
pub(crate) fn give<S: Simd>(
    wrench: &mut Wrench,
    vectors: Vec3x8<S>,
    arms: Vec3x8<S>,
    lanes: usize,
    scale: f64,
) {
    for lane in 0..lanes {
        let of = |of: Vec3x8<S>| DVec3::new(of[0][lane].into(), of[1][lane].into(), of[2][lane].into());
        let vector = of(vectors);
        if vector != DVec3::ZERO {
            wrench.add(vector * scale, of(arms));
        }
    }
}

/// Range of walls, and their volume fraction at the surface. The lattice of given spacing begins half a spacing from the
/// wall, and has rest density far from walls.
///
/// The half-space integral of the smoothing function does not suffice. A pair of particles pushes by both of its pressures,
/// a wall only by that of the particle. The first layer would sink into the wall. The profile therefore has twice the slope
/// of the missing lattice, and its value.
#[must_use]
pub fn boundary_profile(smoothing: &Wendland, spacing: f32) -> (f32, f32) {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32 + 1;
    let full = Wendland::lattice_sum(radius, d);
    // Sum over the lattice at and beyond the wall, and its slope with the distance.
    let (mut missing, mut slope) = (0.0, 0.0);
    for layer in 1..=reach {
        let y = f64::from(layer) * d;
        for (i, k) in (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |k| (i, k))) {
            let distance = (f64::from(i * i + k * k) * d * d + y * y).sqrt();
            missing += d.powi(3) * Wendland::value_f64(radius, distance) / full;
            slope += d.powi(3) * Wendland::gradient_f64(radius, distance) * y / full;
        }
    }
    let range = 0.5 * d + 6.0 * missing / (2.0 * slope);
    let share = missing * (range / (range - 0.5 * d)).powi(6);
    (range as f32, share as f32)
}

/// Factors from the pressure of a particle to the stress that pairs and walls transmit: far from walls, and in the first
/// layer beside one. They are a third of the trace of `sum_j c_ij x_ij x_ij` in a lattice.
///
/// Sums over few neighbours differ from the integrals that they stand for, and no pairs cross a wall. The pressures of the
/// solve are therefore slightly higher there.
#[must_use]
pub fn pressure_moments(smoothing: &Wendland, spacing: f32) -> (f64, f64) {
    let (radius, d) = (f64::from(smoothing.support_radius), f64::from(spacing));
    let reach = (radius / d).ceil() as i32;
    let volume = d.powi(3) / Wendland::lattice_sum(radius, d);
    // Along x, by all pairs and by those that do not cross a wall across y.
    let (mut full, mut beside) = (0.0, 0.0);
    for (x, y, z) in (-reach..=reach)
        .flat_map(|x| (-reach..=reach).flat_map(move |y| (-reach..=reach).map(move |z| (x, y, z))))
    {
        let distance = f64::from(x * x + y * y + z * z).sqrt() * d;
        let part = volume * Wendland::gradient_f64(radius, distance) * (f64::from(x) * d).powi(2);
        full += part;
        beside += if y >= 0 { part } else { 0.0 };
    }
    (full, (full + 2.0 * beside) / 3.0)
}

/// The wrenches of every chunk of `rows` rows.
pub(crate) fn per_chunk(wrenches: &mut [Wrench], rows: usize, bodies: usize) -> Vec<&mut [Wrench]> {
    by_chunk(wrenches, rows.div_ceil(CHUNK), bodies)
}
