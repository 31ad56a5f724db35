//! The water.

use glam::Vec3;

use super::{FluidBlock, Scene};

/// Support radius of the surface energy, over that of the fluid. With as few neighbours as the pressure has, particles at
/// the surface settle in rows without a deficit. The tension is then a tenth of the value of the scene.
const COHESION_SUPPORT: f32 = 2.0;

/// The water: one liquid, initially in blocks and in saturated sponges.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Fluid {
    /// Distance of neighbouring particles at rest. Range 1e-4 to 1 m; default 0.005.
    ///
    /// Half the spacing gives 8 times the particles and half the step. A sponge's `edge` should be 2 to 3 times as long.
    pub spacing: f32,
    /// Density at rest. Range 1 to 20000 kg/m^3; default 1000.
    pub rest_density: f32,
    /// Support radius of the smoothing function over `spacing`. Range 1.8 to 3; default 2.
    ///
    /// Below 1.8 a particle has too few neighbours. Cost grows with the cube.
    pub support: f32,
    /// How pressure is computed; default `divergence`, or `dfsph` where sponges are coupled as in the paper.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub solver: Option<FluidSolver>,
    /// Mean density error, of either sign, at which the pressure solve stops at the latest. Range 1e-6 to 0.1; default 0.001.
    ///
    /// The resulting compression is about half of it.
    pub density_tolerance: f32,
    /// Largest number of iterations of the pressure solve in a step. Range 1 to 1000; default 200.
    ///
    /// Deep water needs more: with 50, a column 30 particles deep does not come to rest.
    pub rounds: u32,
    /// Iterations of `pbf` in a step. Range 1 to 100; default 4.
    pub projections: u32,
    /// How water and sponges are coupled; default: `porous` with `vbd` as the solver of every sponge and any but `wcsph` of the
    /// water, else `paper`.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub coupling: Option<Coupling>,
    /// Nodes that a particle in a sponge exchanges momentum with. `barycentric` needs the coupling `porous` and the solver
    /// `divergence`, and is then the default, unless the suction of a sponge can exceed its Young's modulus. Else `smoothed`.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub coupling_weights: Option<CouplingWeights>,
    /// Pressure as a function of density; default `tait`. For `wcsph`.
    pub equation_of_state: EquationOfState,
    /// Speed of sound of the model. Range 0.1 to 2000 m/s; default derived, see [`Scene::default_sound_speed`].
    ///
    /// Below 10 times the fastest speed the water is visibly compressible. The step of `wcsph` shrinks in proportion to it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub sound_speed: Option<f32>,
    /// Dynamic viscosity. Range 0 to 1000 Pa s; default 0.001 (water).
    pub viscosity: f32,
    /// Form of the viscosity between neighbours; default `morris`, and `strain_rate` for `implicit` viscosity. `strain_rate` needs a solver
    /// other than `wcsph`, for which the default is always `morris`.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub viscosity_form: Option<ViscosityForm>,
    /// How viscosity is integrated; default `explicit`. `implicit` is faster above some Pa s at a spacing of 5 mm.
    pub viscosity_integration: ViscosityIntegration,
    /// Tolerance of the solve for `implicit` viscosity: residual over the change of the velocities in a step. Range 1e-6 to
    /// 0.1; default 0.001.
    pub viscosity_tolerance: f32,
    /// Largest number of iterations of the solve for `implicit` viscosity in a step. Range 1 to 1000; default 200.
    ///
    /// If they do not suffice, the fluid flows as if it were less viscous.
    pub viscosity_rounds: u32,
    /// Numerical viscosity: Monaghan's alpha, which damps approaching particles. Range 0 to 1; default 0.05, with `divergence` 0.
    ///
    /// Below 0.01 the pressure of other solvers is noisy. Above 0.2 the water looks like oil.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub artificial_viscosity: Option<f32>,
    /// Surface tension. Range 0 to 10 N/m; default 0 (off; water has 0.072).
    ///
    /// Solvers with a pressure solve derive it from a surface energy, `wcsph` from the colour field as in the paper. With the former water
    /// meets walls and bodies at a right angle, and draws them together where it lies between them.
    pub surface_tension: f32,
    /// Force that holds a drop on walls and bodies, over the width of the drop. Range 0 to 1 N/m; default 0 (off). Water on plastic has
    /// 0.02: its surface tension times the difference of the cosines of its receding and advancing contact angles \[F62\]. Acts on water
    /// one particle thick; needs `solver` = "divergence".
    pub retention: f32,
    /// Whether water sticks to the walls of the container (no-slip); default false: it slides along them (free slip). Bodies
    /// have a key of their own. Matters where the boundary layer is at least a spacing thick.
    pub no_slip: bool,
    /// Fraction of the normal velocity that a collision with elastic walls and bodies removes. Range 0 to 1; default 0.1.
    pub repulsion_damping: f32,
    /// Absorption of red, green and blue light in pictures. Range 0 to 100000 1/m; default (8, 2, 1.1), that of blue water in a small
    /// tank.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "serde", schemars(with = "Option<[f32; 3]>"))]
    pub absorption: Option<Vec3>,
    /// Colour of deep fluid in pictures: linear red, green and blue. Range 0 to 1; default (0.03, 0.17, 0.22).
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    #[cfg_attr(feature = "serde", schemars(with = "Option<[f32; 3]>"))]
    pub colour: Option<Vec3>,
    /// Blocks of water at time zero; they must not overlap.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub blocks: Vec<FluidBlock>,
}

impl Default for Fluid {
    fn default() -> Self {
        Self {
            spacing: 0.005,
            rest_density: 1000.0,
            support: 2.0,
            solver: None,
            density_tolerance: 1e-3,
            rounds: 200,
            projections: 4,
            coupling: None,
            coupling_weights: None,
            equation_of_state: EquationOfState::Tait,
            sound_speed: None,
            viscosity: 0.001,
            viscosity_form: None,
            viscosity_integration: ViscosityIntegration::Explicit,
            viscosity_tolerance: 1e-3,
            viscosity_rounds: 200,
            artificial_viscosity: None,
            surface_tension: 0.0,
            retention: 0.0,
            no_slip: false,
            repulsion_damping: 0.1,
            absorption: None,
            colour: None,
            blocks: Vec::new(),
        }
    }
}

impl Fluid {
    /// Support radius of the smoothing function: `support * spacing` \[m\].
    #[must_use]
    pub fn support_radius(&self) -> f32 {
        self.support * self.spacing
    }

    /// Monaghan's alpha: `artificial_viscosity`, or the default of a solver.
    #[must_use]
    pub fn numerical_viscosity(&self, solver: FluidSolver) -> f32 {
        self.artificial_viscosity.unwrap_or(if solver == FluidSolver::Divergence { 0.0 } else { 0.05 })
    }

    /// `viscosity_form`, or the default of a solver: what the forms differ in counts where fluids are thick, and water need not pay for it.
    #[must_use]
    pub fn form_of_viscosity(&self, solver: FluidSolver) -> ViscosityForm {
        let is_thick =
            self.viscosity_integration == ViscosityIntegration::Implicit && solver != FluidSolver::Wcsph;
        let default = if is_thick { ViscosityForm::StrainRate } else { ViscosityForm::Morris };
        self.viscosity_form.unwrap_or(default)
    }

    /// Radius of the neighbour search \[m\]: the support radius or, with a surface energy, that of the energy.
    #[must_use]
    pub fn neighbor_radius(&self) -> f32 {
        let is_solved = !matches!(self.solver, Some(FluidSolver::Wcsph | FluidSolver::Pbf));
        let is_tense = self.surface_tension > 0.0 && is_solved;
        if is_tense { COHESION_SUPPORT * self.support_radius() } else { self.support_radius() }
    }
}

/// How pressure is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum FluidSolver {
    /// By an equation of state from the density: weakly compressible SPH, many short steps (the paper).
    Wcsph,
    /// By a pressure solve that keeps the rest density: few long steps \[BK17\]. Water resists shear like a pile of spheres.
    Dfsph,
    /// By a pressure solve that keeps the velocities free of divergence, with gradients that are exact for particles in any order
    /// (docs/pressure-solve.md). Water flows without friction of its own, and bodies sink and float by their weight.
    /// Sponges are porous media with it: not with `coupling` = "paper".
    #[default]
    Divergence,
    /// Position based fluids \[MM13\]: particles are moved to the rest density in a fixed number of iterations. Fixed cost
    /// and always stable, but compressible, depending on `projections` and on the step.
    Pbf,
}

/// Form of the viscosity between neighbours.
///
/// Numerical viscosity (`artificial_viscosity`) has the form `monaghan` in any case, except for `wcsph` with `morris`,
/// which is the model of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ViscosityForm {
    /// Between all components of the velocities: accurate in shear, conserves linear momentum \[MFZ97; MCG03\].
    Morris,
    /// Between the components along the line between the particles: conserves angular momentum as well. Less accurate where
    /// particles lie in rows \[M92\].
    Monaghan,
    /// By the rate of strain: all components beside those of the local rotation, so that a fluid that turns feels nothing. Conserves both
    /// momenta, and free surfaces have no stress. For any solver but `wcsph` (docs/viscosity.md).
    StrainRate,
}

/// How viscosity is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ViscosityIntegration {
    /// As a force at the beginning of the step. The diffusion of velocity over a support radius bounds the step. For water.
    #[default]
    Explicit,
    /// By a solve for the velocities at the end of the step, numerical viscosity included. Steps may be a hundred times as long.
    /// For honey.
    Implicit,
}

/// How water and sponges are coupled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Coupling {
    /// The model of the paper: suction, and drag after the sponge has moved. The material of the sponge has no volume.
    Paper,
    /// Porous media: the material of the sponge displaces water. Drag, elasticity and contact are one solve. Needs `vbd` as the
    /// solver of every sponge and any but `wcsph` of the water.
    Porous,
}

/// Nodes of a sponge that a particle in it exchanges momentum with, by drag and pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum CouplingWeights {
    /// All nodes within the suction radius, by the smoothing function: 28 nodes.
    Smoothed,
    /// The four corners of the tet around the particle, by its barycentric coordinates. Frames with soaked sponges take 0.77 to 0.87
    /// of the time. A suction beyond Young's modulus crushes a sponge, and throws nodes without water in their tets, which have no
    /// drag.
    Barycentric,
}

/// Pressure as a function of density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum EquationOfState {
    /// Stiffer under compression: `rest_density * sound_speed^2 / 7 * ((density / rest_density)^7 - 1)`.
    #[default]
    Tait,
    /// Proportional to compression: `sound_speed^2 * (density - rest_density)`.
    Linear,
}

impl Scene {
    /// How pressure is computed: [`Fluid::solver`], or its default; none without a fluid.
    #[must_use]
    pub fn fluid_solver(&self) -> Option<FluidSolver> {
        let fluid = self.fluid.as_ref()?;
        let is_paper = fluid.coupling == Some(Coupling::Paper) || !self.are_sponges_descended();
        let default =
            if is_paper && !self.sponges.is_empty() { FluidSolver::Dfsph } else { FluidSolver::default() };
        Some(fluid.solver.unwrap_or(default))
    }

    /// How water and sponges are coupled: [`Fluid::coupling`], or what the solvers allow.
    #[must_use]
    pub fn coupling(&self) -> Coupling {
        let chosen = self.fluid.as_ref().and_then(|fluid| fluid.coupling);
        let allowed = if self.allows_porous() { Coupling::Porous } else { Coupling::Paper };
        chosen.unwrap_or(allowed)
    }

    /// Nodes that particles in sponges exchange momentum with: [`Fluid::coupling_weights`], or the default.
    #[must_use]
    pub fn coupling_weights(&self) -> CouplingWeights {
        let chosen = self.fluid.as_ref().and_then(|fluid| fluid.coupling_weights);
        let bears = |sponge: &super::Sponge| sponge.largest_suction() <= sponge.young_modulus;
        let is_default = self.allows_barycentric() && self.sponges.iter().all(bears);
        let default = if is_default { CouplingWeights::Barycentric } else { CouplingWeights::Smoothed };
        chosen.unwrap_or(default)
    }

    /// Whether the coupling and the solver allow [`CouplingWeights::Barycentric`].
    pub(super) fn allows_barycentric(&self) -> bool {
        self.fluid_solver() == Some(FluidSolver::Divergence) && self.coupling() == Coupling::Porous
    }

    /// Whether the solvers allow [`Coupling::Porous`].
    pub(super) fn allows_porous(&self) -> bool {
        self.fluid_solver().is_some_and(|solver| solver != FluidSolver::Wcsph) && self.are_sponges_descended()
    }

    /// Whether every sponge is solved by vertex block descent, the only solver of porous media.
    fn are_sponges_descended(&self) -> bool {
        self.sponges.iter().all(|sponge| sponge.solver == super::Solver::Vbd)
    }

    /// Speed of sound where [`Fluid::sound_speed`] is absent \[m/s\]: 10 times the fastest expected speed, at least 5. The
    /// water may gain that speed by its fall through the scene, its initial velocity, or the suction of sponges.
    ///
    /// A factor of ten keeps the density within 1 %. Zero for a scene without fluid.
    #[must_use]
    pub fn default_sound_speed(&self) -> f32 {
        let Some(fluid) = &self.fluid else { return 0.0 };
        let (minimum, maximum) = self.bounds();
        let floor = minimum.y;
        let tops = fluid.blocks.iter().map(|block| block.maximum.y);
        let soaked = self.sponges.iter().filter(|sponge| sponge.saturation > 0.0).map(|s| s.maximum().y);
        let streams = self.emitters.iter().map(|emitter| emitter.position.y);
        let height = tops
            .chain(soaked)
            .chain(streams)
            .map(|top| (top - floor).min(maximum.y - floor))
            .fold(0.0, f32::max);
        let fall = 2.0 * self.gravity.length() * height;
        let of_streams = self.emitters.iter().map(|emitter| emitter.velocity.length_squared());
        let of_blocks = fluid.blocks.iter().map(|block| block.velocity.length_squared());
        let start = of_blocks.chain(of_streams).fold(0.0, f32::max);
        let pull = self.sponges.iter().map(|sponge| 2.0 * sponge.entry_pressure / fluid.rest_density);
        let fastest = (fall + start).max(pull.fold(0.0, f32::max)).sqrt();
        (10.0 * fastest).max(5.0)
    }
}
