//! Predicted positions of the particles: at the end of the step without a change of their pressure.
//!
//! ```text
//! x*_i = x_i + h v_i, kept inside the walls
//! ```
//!
//! and the compression that the pressure solve has to permit. The stabilisation asks for `w` (`sph::factors`). Permitted at
//! once, that is an undamped spring. In steps shorter than the time in which sound crosses a spacing, compressed water then
//! returns all energy, and nothing damps single particles. The permitted compression is therefore a state s of the particle.
//! It follows w as the strain of a Kelvin-Voigt material, with a delay of `8 sqrt(e)`, several times that of critical
//! damping of the shortest waves:
//!
//! ```text
//! s_next = s + b (w - s),   b = min(1, max(h / (h + 8 sqrt(e)), 0.2 h^2 / e))
//! ```
//!
//! The solve uses `s + b (w - s)` and changes `b w` itself. At rest `s = w` for any step.

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

/// Share of the difference to w by which the permitted compression changes in a step.
fn prompt_share(fluid: &FluidParams, step: f32) -> f32 {
    let prompt = fluid.prompt_roughness(step);
    if prompt < fluid.roughness { prompt / fluid.roughness } else { 1.0 }
}
