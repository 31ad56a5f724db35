//! Wetness of the material at every node, and what depends on it beside elasticity.
//!
//! ```text
//! s_a  = 1 + swelling w_a                            length at rest over that of dry material
//! S_a <- S_a max(chi_a, 1) phi / (1 - (1 - phi) / s_a^3)
//! w_a <- (tau w_a + h S_a) / (tau + h)               material becomes wet in the time tau
//! m_a  = max(S_a^(n - 1), 1/1000)                    k_r / S with the relative permeability k_r = S^n [BC64]
//! r_a <- clamp(r_a + (S_a before - S_a) / B, 0, 1)   0 where water advances, 1 where it recedes
//! p_a  = -(p_e + r_a (p_r - p_e)) (1 + g max(1 - S_a, 0))
//! ```
//!
//! with S at most 1 except in the last line. A swollen sponge has wider pores. The sum chi of W at inner nodes, by which
//! `couple::saturation` divides, is 1.05, because a node is the centre of its own W. For evenly spread water it is 1.
//!
//! The volume flux of water at saturation S is `K k_r / mu` times the pressure gradient. Its velocity is the flux over
//! `phi S`: as in full pores of permeability `K m`.
//!
//! Suction depends on the saturation of the node alone. `sum_i V_0 dW_ia` times the volume of the node is the change of its
//! filled pore volume. The work over a cycle is therefore that of `-p_a` along S. Energy is lost where r is at one of its
//! ends, because pores empty against the higher pressure. In between r is a function of S without a jump, so that small
//! changes of S within the band B lose nothing.

use crate::{
    columns::{Columns, lane},
    cpu::Cpu,
    kernel::declare,
    params::{Params, SpongeParams},
};

declare! {
    needs: [Fluid, Sponge, Porous, Wetting],
    reads: [
        ControlNode, ControlPosition, ControlSaturation, NodeSponge, NodeSuction, NodeInterior, NodeWetting,
    ],
    writes: [ControlSaturation, ControlSuction, NodeSaturation, NodeWetting],
    oracle: crate::oracle::wetting::wetting,
    // Changes of the saturation of a hundredth over a band of a tenth: rounding of the saturation counts a thousand times.
    bound: 2e-4,
    twin_bound: 5e-5,
    twin: [pass(NAME, Nodes)],
    constants: {
        /// Change of the saturation over which the suction goes from that of advancing water to that of receding water.
        pub const SCANNING_BAND: f32 = 0.1;
        /// Least mobility: drag stays finite where a kernel reaches into dry pores.
        pub(crate) const MINIMUM_MOBILITY: f32 = 1.0e-3;
    },
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let (nodes, controls) = (&mut columns.nodes, &mut columns.controls);
    let (order, position) = (&controls.node, &controls.position);
    if nodes.wetting.is_empty() {
        return;
    }
    controls.suction.clear();
    controls.suction.resize(position.len(), 0.0);
    let mut now = vec![[0.0; 4]; order.len()];
    let rows = (&mut now[..], &mut controls.saturation[..order.len()], &mut controls.suction[..order.len()]);
    cpu.for_chunks(rows, |first, (now, saturation, suction)| {
        for (row, node) in order[first..].iter().take(now.len()).enumerate() {
            let node = *node as usize;
            let sponge = &params.sponges[nodes.sponge[node] as usize];
            let before = nodes.wetting[node];
            let filled = saturation[row] * of_even(sponge, before[0], nodes.interior[node]);
            let (wetting, pressure) = of_node(sponge, before, filled, params.step);
            now[row] = wetting;
            saturation[row] = filled;
            suction[row] =
                pressure * nodes.suction[node] * position[first + row][lane::controls::position::VOLUME];
        }
    });
    nodes.saturation.clear();
    nodes.saturation.resize(nodes.position.len(), 0.0);
    for ((node, now), saturation) in order.iter().zip(&now).zip(&controls.saturation) {
        nodes.wetting[*node as usize] = *now;
        nodes.saturation[*node as usize] = *saturation;
    }
}

/// The saturation of a node of this wetness in evenly spread water, over the value of `couple::saturation`.
fn of_even(sponge: &SpongeParams, wetness: f32, interior: f32) -> f32 {
    let interior = if interior > 1.0 { interior } else { 1.0 };
    if sponge.wetting.swelling <= 0.0 {
        return interior;
    }
    let size = sponge.wetting.size(wetness);
    let porosity = 1.0 - (1.0 - sponge.porosity) / (size * size * size);
    interior * (sponge.porosity / porosity)
}

/// The wetting row of a node at a saturation, and its control pressure \[Pa\].
fn of_node(sponge: &SpongeParams, before: [f32; 4], saturation: f32, step: f32) -> ([f32; 4], f32) {
    let own = &sponge.wetting;
    let [wetness, saturation_before, receding, _] = before;
    let filled = if saturation < 1.0 { saturation } else { 1.0 };
    let mut mobility = 1.0;
    for _ in 1..own.exponent {
        mobility *= filled;
    }
    let mobility = if mobility > MINIMUM_MOBILITY { mobility } else { MINIMUM_MOBILITY };
    let receding = receding + (saturation_before - filled) * (1.0 / SCANNING_BAND);
    let receding = if receding > 0.0 { receding } else { 0.0 };
    let receding = if receding < 1.0 { receding } else { 1.0 };
    let pressure = sponge.control_pressure(saturation, receding);
    let wetness = (own.time * wetness + step * filled) / (own.time + step);
    ([wetness, filled, receding, mobility], pressure)
}
