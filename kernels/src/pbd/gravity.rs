//! External acceleration of the nodes: gravity, to which the fluid adds its own.

use crate::{
    columns::{Column::*, Columns},
    cpu::Cpu,
    kernel::{Kernel, Need},
    params::Params,
};

/// `pbd::gravity`.
pub static KERNEL: Kernel =
    Kernel { name: "pbd::gravity", needs: &[Need::Sponge], reads: &[], writes: &[NodeAcceleration], cpu };

fn cpu(_cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let [x, y, z] = params.gravity.to_array();
    let nodes = &mut columns.nodes;
    nodes.acceleration.clear();
    nodes.acceleration.resize(nodes.position.len(), [x, y, z, 0.0]);
}
