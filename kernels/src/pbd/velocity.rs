//! Velocity from the corrected positions (the paper, Figure 2).
//!
//! ```text
//! v = (y - x) / h,   x <- y
//! ```

use crate::{
    columns::{Columns, Nodes},
    cpu::Cpu,
    grid::sort::per_chunk,
    kernel::declare,
    params::Params,
};

declare! {
    needs: [Sponge],
    reads: [NodePosition, NodeVelocity, NodePredicted],
    writes: [NodePosition, NodeVelocity, NodeExtremes],
    oracle: crate::oracle::pbd::velocity,
    bound: 1e-6,
    // Nodes of sponges that are asleep have an inverse mass on a device.
    twin_reads: [NodeSponge],
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let count = columns.rows.nodes;
    let Nodes { position, velocity, predicted, extremes, .. } = &mut columns.nodes;
    let rate = 1.0 / params.step;
    let rows = (&mut position[..count], &mut velocity[..count], per_chunk(&mut extremes.0, count));
    cpu.for_chunks(rows, |first, (position, velocity, extreme)| {
        let extreme = &mut extreme.0[0];
        let mut largest = 0.0_f32;
        if params.asleep.has_all(first..first + position.len()) {
            return;
        }
        for (row, (x, v)) in position.iter_mut().zip(velocity).enumerate() {
            if params.asleep.has(first + row) {
                continue;
            }
            let y = predicted[first + row];
            (0..3).for_each(|axis| v[axis] = (y[axis] - x[axis]) * rate);
            *x = y;
            let square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
            largest = if square > largest { square } else { largest };
            if !square.is_finite() && extreme.not_finite == 0 {
                extreme.not_finite = (first + row + 1) as u32;
            }
        }
        extreme.speed_squared = largest;
    });
}
