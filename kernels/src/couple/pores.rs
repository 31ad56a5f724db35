//! Porosity, permeability and drag rates of a deformed sponge.
//!
//! ```text
//! J_a     = mean of V / V_0 over the tets of a node, by the volume that they stand for
//! phi_a   = 1 - (1 - phi) / J_a                                   the volume of the material stays
//! K_a     = K (phi_a / phi)^3 ((1 - phi) / (1 - phi_a))^2         [C37]
//! beta_a  = mu phi_a / (rho K_a),   gamma_a = c_F phi_a^2 / sqrt(K_a)
//! ```
//!
//! Water with the velocity w relative to the material is decelerated at the rate `beta + gamma |w|`, by Darcy's law and
//! Forchheimer's term. Both rates are stored times J. Their sums over nodes near a particle, with the volumes of the nodes
//! at rest, are then sums over the present volume. A swollen node has a larger volume at rest (`couple::controls`): the
//! stored ratio is relative to that. The porosity is that of the present volume, in which the volume of the dry material is
//! constant.

use crate::{
    columns::{Columns, Nodes},
    cpu::Cpu,
    kernel::declare,
    lanes::{self, LANES, Simd, f32x8, with_lanes},
    params::{Params, SpongeParams},
    pbd::{
        lattice::VERTEX_COLORS,
        stars::{StarGroup, StarShape},
    },
    vector::{Vec3x8, cross, dot, minus},
};

declare! {
    needs: [Fluid, Sponge],
    reads: [NodePosition, NodeStars, NodeSponge, NodeWetting],
    writes: [NodePores],
    oracle: crate::oracle::porous::pores,
    bound: 1e-5,
    twin: [pass(NAME, Nodes)],
    constants: {
        /// Porosity below which pores do not get narrower: the lattice can be crushed flat, pores cannot.
        pub(crate) const MINIMUM_POROSITY: f32 = 0.15;
        /// Volume over that at rest beyond which pores do not get wider: the material would vanish, and drag with it.
        pub(crate) const MAXIMUM_VOLUME_RATIO: f32 = 10.0;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Nodes { position, sponge, stars, pores, wetting, .. } = &mut columns.nodes;
    pores.clear();
    pores.resize(position.len(), [0.0; 4]);
    for color in 0..VERTEX_COLORS {
        cpu.for_chunks(&mut pores[stars.rows(color)], |first, pores| {
            let groups = stars.groups_from(color, first);
            with_lanes!(cpu, simd => {
                for (group, pores) in groups.iter().zip(pores.chunks_mut(LANES)) {
                    if params.asleep.has_group(&group.own) {
                        continue;
                    }
                    let edges = group.own.map(|node| params.sponges[sponge[node as usize] as usize].edge);
                    let places = (&position[..], lanes::load_array(simd, &edges));
                    let [volume, weight] = volumes(simd, group, &stars.shape, places);
                    for (lane, pores) in pores.iter_mut().enumerate() {
                        let node = group.own[lane] as usize;
                        let sponge = &params.sponges[sponge[node] as usize];
                        *pores = of_node(sponge, volume[lane], weight[lane]);
                        if let Some([wetness, ..]) = wetting.get(node) {
                            let size = sponge.wetting.size(*wetness);
                            let swollen = size * size * size;
                            (0..3).for_each(|k| pores[k] /= swollen);
                        }
                    }
                }
            });
        });
    }
}

/// Sum of the volumes of the tets of eight nodes over those at rest, with the weights of the tets. Beside it the sum of the weights.
#[inline(always)]
fn volumes<S: Simd>(
    simd: S,
    group: &StarGroup,
    shape: &StarShape,
    (position, edge): (&[[f32; 4]], f32x8<S>),
) -> [[f32; LANES]; 2] {
    let zero = lanes::splat(simd, 0.0);
    let own = places(simd, position, &group.own);
    let (mut sum, mut weights) = (zero, zero);
    let scale = lanes::splat(simd, 2.0) / (edge * edge * edge);
    for (tet, [partner, q, r]) in shape.tets.iter().enumerate() {
        let u = places(simd, position, &group.neighbors[*partner]);
        let q = places(simd, position, &group.neighbors[*q]);
        let r = places(simd, position, &group.neighbors[*r]);
        let weight = lanes::load_array(simd, &group.tets[tet]);
        let area = cross(minus(q, u), minus(r, u));
        sum += dot(minus(u, own), area) * scale * weight;
        weights += weight;
    }
    [sum.to_array(), weights.to_array()]
}

/// Positions of eight nodes.
#[inline(always)]
fn places<S: Simd>(simd: S, position: &[[f32; 4]], rows: &[u32; LANES]) -> Vec3x8<S> {
    let [x, y, z, _] = lanes::gather_rows(simd, position, rows);
    [x, y, z]
}

/// J, beta J \[1/s\], gamma J \[1/m\] and porosity of a node.
fn of_node(sponge: &SpongeParams, volume: f32, weight: f32) -> [f32; 4] {
    if !sponge.pores_close {
        return [1.0, sponge.drag_rate, sponge.inertial_drag_rate, sponge.porosity];
    }
    // Volume ratio at the smallest porosity.
    let minimum = (1.0 - sponge.porosity) / (1.0 - MINIMUM_POROSITY.min(sponge.porosity));
    let ratio = volume / weight;
    let ratio = if ratio > minimum { ratio } else { minimum };
    let ratio = if ratio < MAXIMUM_VOLUME_RATIO { ratio } else { MAXIMUM_VOLUME_RATIO };
    let porosity = 1.0 - (1.0 - sponge.porosity) / ratio;
    let opening = porosity / sponge.porosity;
    let crowding = (1.0 - sponge.porosity) / (1.0 - porosity);
    let permeability = opening * opening * opening * (crowding * crowding);
    [
        ratio,
        sponge.drag_rate * opening / permeability * ratio,
        sponge.inertial_drag_rate * (opening * opening) / permeability.sqrt() * ratio,
        porosity,
    ]
}
