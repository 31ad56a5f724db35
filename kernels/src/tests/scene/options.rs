//! What scenes of the tests contain.

use crate::{columns::Column, kernel::Kernel, need::Need, params::EquationOfState};

/// Spacing of the particles of a block that is not refined \[m\].
pub(super) const SPACING: f32 = 0.005;

/// Particles of the whole block: 13 x 9 x 9.
pub(in crate::tests) const BLOCK: usize = 1053;

/// What a scene contains.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Options {
    /// Particles; beyond [`BLOCK`] they are closer together.
    pub(crate) fluid: usize,
    pub(crate) sponges: bool,
    pub(crate) bodies: bool,
    pub(crate) walls: bool,
    pub(crate) bounded: bool,
    pub(crate) equation_of_state: EquationOfState,
    pub(crate) incompressible: bool,
    /// Whether the pressure is solved for the divergence of the velocities.
    pub(crate) divergence: bool,
    pub(crate) porous: bool,
    /// Whether particles exchange momentum with the corners of their tets.
    pub(crate) barycentric: bool,
    pub(crate) cohesion: bool,
    /// Whether properties depend on how wet sponges are, where a kernel asks.
    pub(crate) wetting: bool,
    pub(crate) implicit_viscosity: bool,
    /// Whether there is viscosity by the rate of strain.
    pub(crate) strain_rate: bool,
    /// Whether films and drops stick to what they lie on.
    pub(crate) retention: bool,
    /// Axes on which space repeats, by the length of the block; for scenes without sponges.
    pub(crate) periodic: [bool; 3],
    /// Whether sponges touch each other, where a kernel asks.
    pub(crate) touch: bool,
    /// Whether one of the bodies is a compound.
    pub(crate) compound: bool,
    /// Whether the first sponge has a finer lattice, with thousands of nodes.
    pub(crate) fine: bool,
}

/// Everything at once: all ingredients touch each other.
pub(crate) const FULL: Options = Options {
    fluid: BLOCK,
    sponges: true,
    bodies: true,
    walls: true,
    bounded: true,
    equation_of_state: EquationOfState::Tait,
    incompressible: false,
    divergence: false,
    porous: false,
    barycentric: false,
    cohesion: false,
    wetting: false,
    implicit_viscosity: false,
    strain_rate: false,
    retention: false,
    periodic: [false; 3],
    touch: false,
    compound: false,
    fine: false,
};

/// What repeats along two axes, as a channel does, and along all of them.
pub(crate) const CHANNEL: Options = Options { sponges: false, periodic: [true, false, true], ..FULL };
pub(crate) const TORUS: Options = Options {
    fluid: 1000,
    bodies: false,
    walls: false,
    bounded: false,
    sponges: false,
    periodic: [true; 3],
    ..FULL
};

impl Options {
    /// The same, with the pressure that the kernel is there for.
    pub(in crate::tests) fn suiting(self, kernel: &Kernel) -> Self {
        // What fluid does to vertex block descent, it does with sponges as porous media.
        let of_fluid = |column: &Column| {
            matches!(column, Column::NodeFree | Column::NodeTarget | Column::FluidSolidYield)
        };
        let touched = || kernel.reads.iter().chain(kernel.writes).any(of_fluid);
        let porous = kernel.needs.contains(&Need::Porous) || touched();
        // Walls and bodies are part of the surface where pressure is solved for.
        let solves = [Need::Incompressible, Need::Density, Need::Divergence, Need::Cohesion, Need::NoSlip]
            .iter()
            .any(|need| kernel.needs.contains(need));
        let divergence = kernel.needs.contains(&Need::Divergence);
        let cohesion = kernel.needs.contains(&Need::Cohesion);
        let reads = kernel.reads.contains(&Column::NodeWetting);
        let wetting = self.wetting && (reads || porous) || kernel.needs.contains(&Need::Wetting);
        let porous = porous || wetting || divergence && self.sponges;
        let implicit_viscosity = kernel.needs.contains(&Need::ImplicitViscosity);
        // What the rate of strain leaves for a solve, and what is part of it.
        let strain_rate = kernel.needs.contains(&Need::StrainRate)
            || implicit_viscosity && kernel.reads.contains(&Column::FluidViscosityProduct);
        let of_touch = |column: &Column| matches!(column, Column::NodeTouch | Column::NodePairs);
        let touch = kernel.reads.iter().chain(kernel.writes).any(of_touch);
        Self {
            incompressible: porous || solves,
            divergence,
            porous,
            barycentric: kernel.needs.contains(&Need::Barycentric),
            cohesion,
            implicit_viscosity,
            strain_rate,
            retention: kernel.needs.contains(&Need::Retention),
            wetting,
            touch,
            ..self
        }
    }

    /// Sites per site of the coarse block, along each axis.
    pub(super) fn refinement(self) -> usize {
        (1..).find(|n| BLOCK * n * n * n >= self.fluid).unwrap_or(1)
    }

    pub(super) fn spacing(self) -> f32 {
        SPACING / self.refinement() as f32
    }
}

/// Sizes around the width of a vector, and scenes that lack something.
pub(in crate::tests) fn all_options() -> Vec<Options> {
    let mut all = vec![
        FULL,
        Options { bodies: false, bounded: false, equation_of_state: EquationOfState::Linear, ..FULL },
        // A multiple of eight: the last group of eight rows is all padding.
        Options { fluid: 1000, walls: false, bounded: false, ..FULL },
        Options { walls: false, bodies: false, ..FULL },
        Options { sponges: false, ..FULL },
        Options { wetting: true, ..FULL },
        Options { compound: true, ..FULL },
        CHANNEL,
        Options { bounded: false, walls: false, equation_of_state: EquationOfState::Linear, ..CHANNEL },
        TORUS,
    ];
    let few = [0, 1, 7, 8, 9].map(|fluid| Options { fluid, ..FULL });
    all.extend(few);
    all.extend(few.map(|few| Options { sponges: false, bodies: false, ..few }));
    all
}
