//! The water.

use glam::Vec3;

use super::error::Problem;
use super::number::number_text;
use super::{Domain, Scene};

/// Support radius of the energy of the surface over that of the fluid: with as few neighbours as the pressure has, particles at the
/// surface find places where they lack nothing, in rows, and the tension is a tenth of what it should be.
const COHESION_SUPPORT: f32 = 2.0;

/// Part of the length of a box that repeats by which a row of particles may be longer or shorter than it.
const SEAM: f32 = 1e-3;

/// The water: one liquid, seeded as blocks and inside saturated sponges.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct Fluid {
    /// Distance of neighbouring particles at rest. Range 1e-4 to 1 m; default 0.005.
    ///
    /// Halving it gives 8 times the particles and half the step. A sponge's `edge` should be 2 to 3 times as long.
    pub spacing: f32,
    /// Density at rest. Range 1 to 20000 kg/m^3; default 1000.
    pub rest_density: f32,
    /// Support radius of the smoothing kernel over `spacing`. Range 1.8 to 3; default 2.
    ///
    /// Below 1.8 a particle has too few neighbours; cost grows with the cube.
    pub support: f32,
    /// How pressure is found; default `dfsph`.
    pub solver: FluidSolver,
    /// Mean error of the density, of either sign, at which the `dfsph` solve stops. Range 1e-6 to 0.1; default 0.001.
    ///
    /// The compression that is reached is about half of it.
    pub density_tolerance: f32,
    /// Most rounds of the `dfsph` solve in a step. Range 1 to 1000; default 200.
    ///
    /// Deep water needs more: with 50, a column 30 particles deep does not come to rest.
    pub rounds: u32,
    /// Rounds of a step of `pbf`. Range 1 to 100; default 4.
    pub projections: u32,
    /// How water and sponges meet; default: `porous` with the solvers `dfsph` and `vbd`, else `paper`.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub coupling: Option<Coupling>,
    /// Pressure as a function of density; default `tait`. For `wcsph`.
    pub equation_of_state: EquationOfState,
    /// Speed of sound of the model. Range 0.1 to 2000 m/s; default derived, see [`Scene::default_sound_speed`].
    ///
    /// Below 10 times the fastest speed the water is visibly compressible; the step shrinks in proportion to it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub sound_speed: Option<f32>,
    /// Dynamic viscosity. Range 0 to 1000 Pa s; default 0.001 (water).
    pub viscosity: f32,
    /// Between which velocities of neighbours viscosity acts; default `morris`.
    pub viscosity_form: ViscosityForm,
    /// When viscosity acts; default `explicit`. `implicit` is faster above about 10 Pa s at a spacing of 5 mm.
    pub viscosity_integration: ViscosityIntegration,
    /// Error of the change that `implicit` viscosity makes to the velocities in a step, over that change, at which its solve
    /// stops. Range 1e-6 to 0.1; default 0.001.
    pub viscosity_tolerance: f32,
    /// Most rounds of the solve for `implicit` viscosity in a step. Range 1 to 1000; default 200.
    ///
    /// Fluid that is thicker than they suffice for flows as if it were thinner.
    pub viscosity_rounds: u32,
    /// Monaghan's alpha, the damping of approaching particles. Range 0 to 1; default 0.05.
    ///
    /// Below 0.01 the pressure is noisy; above 0.2 the water looks like oil.
    pub artificial_viscosity: f32,
    /// Surface tension. Range 0 to 10 N/m; default 0 (off; water has 0.072).
    ///
    /// With `dfsph` it follows from an energy of the surface, with `wcsph` from the colour field, as in the paper.
    pub surface_tension: f32,
    /// Whether water rests at the walls of the container; default false: it slides along them. Bodies have a key of their
    /// own. Matters where the viscosity is felt over a spacing.
    pub no_slip: bool,
    /// Fraction of the normal velocity that the elastic walls and bodies take away. Range 0 to 1; default 0.1.
    pub repulsion_damping: f32,
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
            solver: FluidSolver::Dfsph,
            density_tolerance: 1e-3,
            rounds: 200,
            projections: 4,
            coupling: None,
            equation_of_state: EquationOfState::Tait,
            sound_speed: None,
            viscosity: 0.001,
            viscosity_form: ViscosityForm::Morris,
            viscosity_integration: ViscosityIntegration::Explicit,
            viscosity_tolerance: 1e-3,
            viscosity_rounds: 200,
            artificial_viscosity: 0.05,
            surface_tension: 0.0,
            no_slip: false,
            repulsion_damping: 0.1,
            blocks: Vec::new(),
        }
    }
}

impl Fluid {
    /// Support radius of the smoothing kernel: `support * spacing` \[m\].
    #[must_use]
    pub fn support_radius(&self) -> f32 {
        self.support * self.spacing
    }

    /// How far apart particles may be that feel each other: the support radius, or that of the energy of the surface, if
    /// there is one \[m\].
    #[must_use]
    pub fn neighbor_radius(&self) -> f32 {
        let is_tense = self.surface_tension > 0.0 && self.solver == FluidSolver::Dfsph;
        if is_tense { COHESION_SUPPORT * self.support_radius() } else { self.support_radius() }
    }
}

/// How pressure is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum FluidSolver {
    /// From the density, by an equation of state: weakly compressible, many short steps (the paper).
    Wcsph,
    /// By a solve that keeps the density at rest density: few long steps \[BK17\].
    #[default]
    Dfsph,
    /// Not at all: particles are moved to where the density is right, in a fixed number of rounds \[MM13\]. Never slow and always
    /// stable, and soft: how far water gives way depends on `projections` and on the step.
    Pbf,
}

/// Between which velocities of neighbours viscosity acts.
///
/// The damping of approaching particles (`artificial_viscosity`) is of the second form in either case, but for `wcsph`
/// with `morris`, which is the model of the paper.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ViscosityForm {
    /// All of the velocity: accurate in shear, keeps linear momentum \[MFZ97; MCG03\].
    #[default]
    Morris,
    /// The velocity along the line between the particles: keeps angular momentum as well, and is less accurate where
    /// particles lie in rows \[M92\].
    Monaghan,
}

/// When viscosity acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum ViscosityIntegration {
    /// At the beginning of the step, as a force: steps are bound by the time in which velocity spreads over a support
    /// radius. For water.
    #[default]
    Explicit,
    /// At the end of the step, by a solve for the velocities, the damping of approaching particles included: steps may be fifty
    /// times as long. For honey.
    Implicit,
}

/// How water and sponges meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Coupling {
    /// The model of the paper: suction, and drag after the sponge has moved; its material takes no room.
    Paper,
    /// Porous media: the material of the sponge displaces water, and drag, elasticity and contact are one solve. Needs
    /// the solvers `dfsph` of the water and `vbd` of every sponge.
    Porous,
}

/// Pressure as a function of density.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum EquationOfState {
    /// Stiffens under compression: `rest_density * sound_speed^2 / 7 * ((density / rest_density)^7 - 1)`.
    #[default]
    Tait,
    /// In proportion to compression: `sound_speed^2 * (density - rest_density)`.
    Linear,
}

/// Axis-aligned block of water at time zero.
///
/// Particles sit at `minimum + (i + 1/2) * spacing`. A block that fills an axis along which the container repeats must be a
/// whole number of spacings long there, within a thousandth. Those that would start inside a sponge or a body are left out: how
/// much water a sponge holds is its own `saturation`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct FluidBlock {
    /// Lowest corner. Range -1000 to 1000 m. Required in files.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub minimum: Vec3,
    /// Highest corner, above `minimum` on every axis. Range -1000 to 1000 m. Required in files.
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub maximum: Vec3,
    /// Velocity at time zero. Range -100 to 100 m/s; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
}

impl FluidBlock {
    /// Block at rest, from corner to corner \[m\].
    #[must_use]
    pub fn new(minimum: Vec3, maximum: Vec3) -> Self {
        Self { minimum, maximum, velocity: Vec3::ZERO }
    }

    /// Number of particles along each axis at a spacing \[m\]; a block thinner than the spacing has none.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the cast saturates, and validation bounds the count"
    )]
    #[expect(clippy::cast_sign_loss, reason = "negative sizes are clamped to zero first")]
    pub fn counts(&self, spacing: f32) -> [u32; 3] {
        // A hundredth of a particle forgives what f32 rounding takes from sizes that are multiples of the spacing.
        let count = |size: f32| (size / spacing + 0.01).floor().max(0.0) as u32;
        (self.maximum - self.minimum).to_array().map(count)
    }

    /// Whether the block reaches from one side of the container to the other along an axis on which that repeats.
    fn fills(&self, scene: &Scene, axis: usize, spacing: f32) -> bool {
        let Domain::Box { minimum, maximum, periodic } = scene.domain else { return false };
        let gap = (maximum - minimum)[axis] - (self.maximum - self.minimum)[axis];
        periodic[axis] && gap < 0.5 * spacing
    }

    /// Number of particles along each axis, and their distance there \[m\]. A row that fills an axis on which the container repeats
    /// has the same distance across its sides as everywhere else.
    pub(crate) fn lattice(&self, scene: &Scene, spacing: f32) -> ([u32; 3], [f32; 3]) {
        let (mut counts, mut pitch) = (self.counts(spacing), [spacing; 3]);
        for axis in (0..3).filter(|axis| self.fills(scene, *axis, spacing)) {
            let (minimum, maximum) = scene.bounds();
            let period = (maximum - minimum)[axis];
            counts[axis] = whole_rows(period, spacing);
            pitch[axis] = period / counts[axis] as f32;
        }
        (counts, pitch)
    }

    /// Adds what is wrong with the block in a container that repeats.
    pub(super) fn seam_rules(&self, key: &str, spacing: f32, scene: &Scene, problems: &mut Vec<Problem>) {
        for axis in (0..3).filter(|axis| self.fills(scene, *axis, spacing)) {
            let (minimum, maximum) = scene.bounds();
            let period = (maximum - minimum)[axis];
            let rows = whole_rows(period, spacing);
            if (rows as f32 * spacing / period - 1.0).abs() > SEAM {
                let (name, spacing) = (["x", "y", "z"][axis], number_text(spacing));
                let (wanted, exact) = (rows as f32, number_text(period / rows as f32));
                let value = format!("({} m along {name})", number_text(period));
                let rule = format!(
                    "fills an axis along which the container repeats, which must be a whole number of \
                     `fluid.spacing` = {spacing} long; {wanted} of {exact} fit"
                );
                problems.push(Problem::rule(key, value, rule));
            }
        }
    }
}

/// The whole number of particles, at least one, that is nearest to a length over the spacing.
#[expect(clippy::cast_possible_truncation, reason = "the cast saturates, and validation bounds the count")]
#[expect(clippy::cast_sign_loss, reason = "at least 1")]
fn whole_rows(length: f32, spacing: f32) -> u32 {
    (length / spacing).round().max(1.0) as u32
}

impl Scene {
    /// How water and sponges meet: [`Fluid::coupling`], or what the solvers allow.
    #[must_use]
    pub fn coupling(&self) -> Coupling {
        let chosen = self.fluid.as_ref().and_then(|fluid| fluid.coupling);
        let allowed = if self.allows_porous() { Coupling::Porous } else { Coupling::Paper };
        chosen.unwrap_or(allowed)
    }

    /// Whether all solvers are those that [`Coupling::Porous`] needs.
    pub(super) fn allows_porous(&self) -> bool {
        self.fluid.as_ref().is_some_and(|fluid| fluid.solver != FluidSolver::Wcsph)
            && self.sponges.iter().all(|sponge| sponge.solver == super::Solver::Vbd)
    }

    /// Speed of sound used where [`Fluid::sound_speed`] is absent \[m/s\]: 10 times the fastest speed that water is
    /// expected to reach from its fall through the scene, its start, or the pull of the sponges; at least 5.
    ///
    /// Ten times keeps density within 1 %. Zero for a scene without fluid.
    #[must_use]
    pub fn default_sound_speed(&self) -> f32 {
        let Some(fluid) = &self.fluid else { return 0.0 };
        let (minimum, maximum) = self.bounds();
        let floor = minimum.y;
        let tops = fluid.blocks.iter().map(|block| block.maximum.y);
        let soaked = self.sponges.iter().filter(|sponge| sponge.saturation > 0.0).map(|s| s.maximum().y);
        let height = tops.chain(soaked).map(|top| (top - floor).min(maximum.y - floor)).fold(0.0, f32::max);
        let fall = 2.0 * self.gravity.length() * height;
        let start = fluid.blocks.iter().map(|block| block.velocity.length_squared()).fold(0.0, f32::max);
        let pull = self.sponges.iter().map(|sponge| 2.0 * sponge.entry_pressure / fluid.rest_density);
        let fastest = (fall + start).max(pull.fold(0.0, f32::max)).sqrt();
        (10.0 * fastest).max(5.0)
    }
}
