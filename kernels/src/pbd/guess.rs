//! First guess of vertex block descent \[CLYX24, section 3.7\].
//!
//! ```text
//! z = y,   y <- z - h^2 (1 - s) a
//! ```
//!
//! The target z is the position without elastic forces. The first guess leaves out the share of the external acceleration a
//! that the node did not follow in the last step. Something held it then. In free fall `s = 1`, at rest `s = 0`. A sponge
//! at rest therefore begins in its equilibrium, and stays there at any number of sweeps.
//!
//! With fluid, `couple::drag_target` shifts the target and adds mass. Contact between sponges is in `pbd::touch`.

use crate::{
    columns::{Columns, Nodes, lane},
    cpu::Cpu,
    kernel::declare,
    params::{Params, Solver},
};

declare! {
    needs: [Sponge, Solver(Vbd)],
    reads: [NodeVelocity, NodeAcceleration, NodeSponge, NodePredicted],
    writes: [
        NodePredicted, NodeFree, NodeTarget, NodeDrag, NodeDragMoment, NodeTouch, NodeTouchStiffness,
        NodeTouchBetween,
    ],
    oracle: crate::oracle::descent::guess,
    bound: 2e-5,
    twin: [pass(NAME, Nodes)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    let Nodes {
        velocity,
        acceleration,
        sponge,
        predicted,
        free,
        target,
        drag,
        drag_moment,
        touch,
        touch_stiffness,
        touch_between,
        ..
    } = &mut columns.nodes;
    // Empty where sponges touch only bodies and walls.
    [touch, touch_stiffness, touch_between].into_iter().for_each(Vec::clear);
    target.resize(predicted.len(), [0.0; 4]);
    for of_fluid in [drag, drag_moment] {
        of_fluid.clear();
        of_fluid.resize(predicted.len(), [0.0; 4]);
    }
    let square = params.step * params.step;
    cpu.for_chunks((&mut predicted[..], &mut target[..]), |first, (predicted, target)| {
        for (row, (y, z)) in predicted.iter_mut().zip(target).enumerate() {
            *z = [
                y[0],
                y[1],
                y[2],
                if y[lane::nodes::predicted::INVERSE_MASS] > 0.0 {
                    1.0 / y[lane::nodes::predicted::INVERSE_MASS]
                } else {
                    0.0
                },
            ];
            let node = first + row;
            if y[lane::nodes::predicted::INVERSE_MASS] > 0.0
                && params.solver(sponge[node]) == Some(Solver::Vbd)
            {
                let lacking = square * (1.0 - velocity[node][lane::nodes::velocity::FOLLOWED_SHARE]);
                (0..3).for_each(|axis| y[axis] -= lacking * acceleration[node][axis]);
            }
        }
    });
    free.clone_from(target);
}
