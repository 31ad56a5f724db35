//! Energy of one node where wet material is softer and larger at rest.
//!
//! A tet has the mean w of the wetness of its nodes, which changes its edge and its constants:
//!
//! ```text
//! a -> a s,   mu -> mu c,   lambda -> lambda c,   s = 1 + swelling w,   c = 1 - softening w
//! ```
//!
//! The energy per volume at rest is that of swollen material at rest, so that Young's modulus refers to it. Of the terms of
//! `descent.rs` then `G` changes by `1 / s^2`, `J` by `1 / s^3`, `a mu / 12` by `s c`, and viscous terms by `c / s`.

use crate::{
    columns::Columns,
    columns::lane::nodes::wetting::WETNESS,
    lanes::{self, LANES, Simd, f32x8, select},
    params::{POLYNOMIAL_RATIO, Params, SpongeParams},
    pbd::{
        descent::{Local, Material, Star, add_outer},
        stars::{NEIGHBORS, StarGroup, StarShape},
    },
    vector::{Vec3x8, cross, dot, minus, plus, times},
};

/// Inputs of wet material; empty where no sponge depends on wetness.
#[derive(Clone, Copy)]
pub(super) struct Wet<'a> {
    pub(super) wetting: &'a [[f32; 4]],
    params: &'a Params,
    sponge: &'a [u32],
}

impl<'a> Wet<'a> {
    /// Of all nodes.
    pub(super) fn new(params: &'a Params, sponge: &'a [u32], wetting: &'a [[f32; 4]]) -> Self {
        let changes = params.sponges.iter().any(|sponge| sponge.wetting.changes_material());
        Self { wetting: if changes { wetting } else { &[] }, params, sponge }
    }
}

/// Wetness of eight nodes and their neighbours, and its effect.
pub(super) struct Wetness<S: Simd> {
    simd: S,
    own: f32x8<S>,
    around: [f32x8<S>; NEIGHBORS],
    softening: f32x8<S>,
    swelling: f32x8<S>,
}

impl<S: Simd> Wetness<S> {
    /// Loads it.
    #[inline(always)]
    pub(super) fn new(simd: S, (group, shape): (&StarGroup, &StarShape), wet: Wet<'_>) -> Self {
        let [own, ..] = lanes::gather_rows(simd, wet.wetting, &group.own);
        let mut around = [lanes::splat(simd, 0.0); NEIGHBORS];
        for (wetness, rows) in around.iter_mut().zip(&group.neighbors).take(shape.neighbors) {
            [*wetness, ..] = lanes::gather_rows(simd, wet.wetting, rows);
        }
        let (mut softening, mut swelling) = ([0.0; LANES], [0.0; LANES]);
        for (lane, node) in group.own.iter().enumerate() {
            let sponge = &wet.params.sponges[wet.sponge[*node as usize] as usize];
            (softening[lane], swelling[lane]) = (sponge.wetting.softening, sponge.wetting.swelling);
        }
        let [softening, swelling] = [lanes::load_array(simd, &softening), lanes::load_array(simd, &swelling)];
        Self { simd, own, around, softening, swelling }
    }

    /// Size and stiffness of a tet of these neighbours, over those of dry material.
    #[inline(always)]
    pub(super) fn of_tet(&self, [u, q, r]: [usize; 3]) -> [f32x8<S>; 2] {
        let (quarter, one) = (lanes::splat(self.simd, 0.25), lanes::splat(self.simd, 1.0));
        let mean = (self.own + self.around[u] + (self.around[q] + self.around[r])) * quarter;
        [one + self.swelling * mean, one - self.softening * mean]
    }
}

impl<S: Simd> Star<'_, S> {
    /// As [`Self::elasticity`], with different constants in each tet.
    #[inline(always)]
    pub(super) fn wetted_elasticity(
        &self,
        material: &Material<S>,
        wetness: &Wetness<S>,
        x: Vec3x8<S>,
    ) -> Local<S> {
        let simd = self.simd;
        let (zero, one) = (lanes::splat(simd, 0.0), lanes::splat(simd, 1.0));
        let two = lanes::splat(simd, 2.0);
        let (mut force, mut stiffness, mut count) = ([zero; 3], [zero; 6], zero);
        let mut strain = zero;
        for (tet, corners) in self.shape.tets.iter().enumerate() {
            let [u, q, r] = *corners;
            let [size, softer] = wetness.of_tet(*corners);
            let present = lanes::load_array(simd, &self.group.tets[tet]);
            let (shear, volume) = (material.shear * (size * softer), material.volume * (size * softer));
            let lame = volume - shear;
            let inverse_edge = material.inverse_edge / size;
            let (partner, q, r) = (self.around[u], self.around[q], self.around[r]);
            let pull = plus(minus(q, x), minus(r, x));
            let area = cross(minus(q, partner), minus(r, partner));
            let area = times(area, inverse_edge * inverse_edge * two);
            let ratio = dot(minus(partner, x), area) * inverse_edge;
            strain = strain.max(select(present.simd_gt(zero), (ratio - one).abs(), zero));
            let inverse = one / ratio.max(lanes::splat(simd, POLYNOMIAL_RATIO as f32));
            let slope = lame * (ratio - one) - shear * inverse * (two - ratio * inverse);
            let own = times(area, present);
            force = plus(force, times(pull, shear * present));
            force = plus(force, times(own, slope * (material.edge * size)));
            add_outer(&mut stiffness, times(own, lame + shear * inverse * inverse), area);
            count += shear * two * present;
        }
        for diagonal in &mut stiffness[..3] {
            *diagonal += count;
        }
        Local { force, stiffness, strain }
    }
}

/// Size and stiffness of a tet over those of dry material, for measures and tests.
#[must_use]
pub fn of_tet(columns: &Columns, sponge: &SpongeParams, tet: &[u32; 4]) -> (f64, f64) {
    let wetting = &columns.nodes.wetting;
    if wetting.is_empty() {
        return (1.0, 1.0);
    }
    let mean = tet.iter().map(|node| f64::from(wetting[*node as usize][WETNESS])).sum::<f64>() * 0.25;
    let (swelling, softening) = (f64::from(sponge.wetting.swelling), f64::from(sponge.wetting.softening));
    (1.0 + swelling * mean, 1.0 - softening * mean)
}
