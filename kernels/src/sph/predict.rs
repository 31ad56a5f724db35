//! Where particles would be at the end of the step without a change of their pressure.
//!
//! ```text
//! x*_i = x_i + h v_i, kept inside the walls
//! ```
//!
//! and the compression that the solve for the pressure has to allow them. For the roughness of the pressure that is `w`
//! (`sph::factors`), but what is allowed at once would be a spring without a damper: where steps are shorter than the time that
//! sound takes for a spacing, water that is pressed together gives back all it took, and what pushes single particles about has
//! nothing to set against it. So what is allowed is a state s of the particle that follows w as in a material of Kelvin and
//! Voigt, with a delay of `8 sqrt(e)`, some times that in which the shortest waves would not swing any more:
//!
//! ```text
//! s_next = s + b (w - s),   b = min(1, max(h / (h + 8 sqrt(e)), 0.2 h^2 / e))
//! ```
//!
//! of which the solve knows `s + b (w - s)` from here and changes `b w` itself. At rest s is w, at any step.

use crate::{
    column::FAR_ROW,
    columns::{Columns, Fluid, lane},
    cpu::Cpu,
    kernel::declare,
    params::{FluidParams, Params},
};

declare! {
    needs: [Fluid, Incompressible],
    reads: [FluidPosition, FluidVelocity, FluidAcceleration],
    writes: [FluidPredicted, FluidVelocity, FluidAcceleration],
    oracle: crate::oracle::incompressible::predict,
    bound: 1e-6,
    twin: [pass(NAME, Fluid)],
}

fn cpu(cpu: &Cpu, params: &Params, columns: &mut Columns) {
    if params.fluid.incompressible.is_none() {
        return;
    }
    let count = columns.rows.fluid;
    let Fluid { position, velocity, acceleration, predicted, .. } = &mut columns.fluid;
    predicted.resize(position.len(), FAR_ROW);
    predicted[count..].fill(FAR_ROW);
    let inside = super::container::inside(params);
    let share = prompt_share(&params.fluid, params.step);
    let rows = (&mut predicted[..count], &mut velocity[..count], &mut acceleration[..count]);
    cpu.for_chunks(rows, |first, (predicted, velocity, acceleration)| {
        let rows = position[first..].iter().zip(velocity).zip(acceleration);
        for (predicted, ((x, v), a)) in predicted.iter_mut().zip(rows) {
            for axis in 0..3 {
                let end = x[axis] + params.step * v[axis];
                predicted[axis] = inside.map_or(end, |(low, high)| end.clamp(low[axis], high[axis]));
            }
            predicted[lane::fluid::predicted::PRESSURE_CHANGE] = 0.0;
            // More than all of the volume is no compression.
            let before = if v[lane::fluid::velocity::ALLOWED_COMPRESSION].abs() <= 1.0 {
                v[lane::fluid::velocity::ALLOWED_COMPRESSION]
            } else {
                0.0
            };
            let allowed = before + share * (a[lane::fluid::acceleration::ALLOWED_COMPRESSION] - before);
            v[lane::fluid::velocity::ALLOWED_COMPRESSION] = allowed;
            a[lane::fluid::acceleration::ALLOWED_COMPRESSION] =
                allowed + share * (a[lane::fluid::acceleration::ALLOWED_COMPRESSION] - allowed);
        }
    });
}

/// Share of the way to w that what is allowed goes in a step.
fn prompt_share(fluid: &FluidParams, step: f32) -> f32 {
    let prompt = fluid.prompt_roughness(step);
    if prompt < fluid.roughness { prompt / fluid.roughness } else { 1.0 }
}
