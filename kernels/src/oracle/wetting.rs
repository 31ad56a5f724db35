//! Properties that depend on the wetness of a sponge.

use super::couple::sponge;
use crate::{
    columns::{Columns, Nodes, lane},
    params::{Params, SpongeParams},
};

/// How wet a node is.
pub(super) fn wetness(nodes: &Nodes, node: usize) -> f64 {
    nodes.wetting.get(node).map_or(0.0, |row| f64::from(row[lane::nodes::wetting::WETNESS]))
}

/// Length of the material of a node at rest over that of dry material.
pub(super) fn size(sponge: &SpongeParams, nodes: &Nodes, node: usize) -> f64 {
    1.0 + f64::from(sponge.wetting.swelling) * wetness(nodes, node)
}

/// The edge of a tet at rest and its stiffness, over those of dry material.
pub(super) fn of_tet(sponge: &SpongeParams, nodes: &Nodes, tet: [usize; 4]) -> (f64, f64) {
    let mean = tet.map(|node| wetness(nodes, node)).iter().sum::<f64>() / 4.0;
    let wetting = &sponge.wetting;
    (1.0 + f64::from(wetting.swelling) * mean, 1.0 - f64::from(wetting.softening) * mean)
}

pub(crate) fn wetting(params: &Params, columns: &mut Columns) {
    let h = f64::from(params.step);
    for control in 0..columns.rows.nodes {
        let sponge = sponge(params, columns, control);
        let own = &sponge.wetting;
        let node = columns.controls.node[control] as usize;
        let dry_porosity = f64::from(sponge.porosity);
        let porosity = 1.0 - (1.0 - dry_porosity) / size(sponge, &columns.nodes, node).powi(3);
        let even = f64::from(columns.nodes.interior[node]).max(1.0) * dry_porosity / porosity;
        let saturation = f64::from(columns.controls.saturation[control]) * even;
        let [wetness, saturation_before, receding, _] = columns.nodes.wetting[node].map(f64::from);
        let filled = saturation.min(1.0);
        let receding = (receding + (saturation_before - filled) / 0.1).clamp(0.0, 1.0);
        let mobility = filled.powi(own.exponent as i32 - 1).max(1e-3);
        let wetness = (f64::from(own.time) * wetness + h * filled) / (f64::from(own.time) + h);
        let pressure = f64::from(sponge.entry_pressure) + receding * f64::from(own.receding);
        let pressure = pressure * (1.0 + f64::from(sponge.saturation_gain) * (1.0 - saturation).max(0.0));
        let volume = f64::from(columns.controls.position[control][lane::controls::position::VOLUME]);
        let suction = -pressure * f64::from(columns.nodes.suction[node]) * volume;
        columns.nodes.wetting[node] = [wetness, filled, receding, mobility].map(|value| value as f32);
        columns.nodes.saturation[node] = saturation as f32;
        columns.controls.saturation[control] = saturation as f32;
        columns.controls.suction[control] = suction as f32;
    }
}
