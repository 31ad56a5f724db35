//! External acceleration of the nodes: gravity, to which the fluid adds its own.

use crate::{columns::Columns, cpu::Cpu, kernel::declare, params::Params};

declare! {
    needs: [Sponge],
    reads: [],
    writes: [NodeAcceleration],
    oracle: crate::oracle::pbd::gravity,
    bound: 0.0,
    twin: [pass(NAME, Nodes)],
}

fn cpu(_cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let [x, y, z] = params.gravity.to_array();
    let nodes = &mut columns.nodes;
    nodes.acceleration.clear();
    nodes.acceleration.resize(nodes.position.len(), [x, y, z, 0.0]);
}
