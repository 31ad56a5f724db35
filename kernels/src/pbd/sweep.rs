//! What a sweep over the nodes of vertex block descent reads.

use crate::{
    body::Body,
    columns::Nodes,
    cpu::Cpu,
    lanes::Simd,
    params::Params,
    pbd::{
        descent::{Material, constants_of},
        meeting::Touch,
        obstacles::Obstacles,
        stars::{StarGroup, Stars},
        wetted::Wet,
    },
};

/// Columns and parameters of a sweep.
pub(super) struct Sweep<'a> {
    cpu: &'a Cpu,
    pub(super) params: &'a Params,
    bodies: &'a [Body],
    pub(super) position: &'a [[f32; 4]],
    pub(super) predicted: &'a [[f32; 4]],
    pub(super) target: &'a [[f32; 4]],
    sponge: &'a [u32],
    pub(super) stars: &'a Stars,
    pub(super) wet: Wet<'a>,
    pub(super) touch: Touch<'a>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(cpu: &'a Cpu, params: &'a Params, bodies: &'a [Body], nodes: &'a Nodes) -> Self {
        let Nodes { position, predicted, target, sponge, stars, wetting, .. } = nodes;
        let touch =
            Touch { force: &nodes.touch, stiffness: &nodes.touch_stiffness, between: &nodes.touch_between };
        let wet = Wet::new(params, sponge, wetting);
        Self { cpu, params, bodies, position, predicted, target, sponge, stars, wet, touch }
    }

    /// The obstacles of a chunk of nodes.
    #[inline(always)]
    pub(super) fn obstacles(&self) -> Obstacles<'a> {
        Obstacles::new(self.cpu, self.params, self.bodies)
    }

    /// The material of eight nodes.
    #[inline(always)]
    pub(super) fn material<S: Simd>(&self, simd: S, group: &StarGroup) -> Material<S> {
        Material::new(simd, &constants_of(self.params, self.sponge, &group.own))
    }
}
