//! Sponges: blocks of a body-centred cubic lattice, or shapes cut out of such blocks.

use glam::{UVec3, Vec3};

use super::{
    BlockShape,
    bodies::{NOWHERE, REMOVED},
};

/// How the elasticity of a sponge is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Solver {
    /// Vertex block descent: a material of `young_modulus`, `poisson_ratio` and `damping`, stable at any step.
    #[default]
    Vbd,
    /// Strain based dynamics, the model of the paper: `stretch_modulus`, `shear_modulus`, `volume_modulus` and
    /// `damping_time`.
    Sbd,
    /// Two coupled Neo-Hookean constraints per tet: at small strain the material of `vbd`, in short steps of one sweep.
    XpbdNeoHookean,
}

/// A sponge: geometry, pores and elasticity.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct Sponge {
    /// Name, unique among sponges and bodies: letters, digits, `_` and `-`, starting with a letter. Required in files.
    pub name: String,
    /// Edge of a lattice cell. Range 1e-4 to 1 m; default 0.01.
    ///
    /// 2 to 3 times the fluid's `spacing` works best. Outside 1 to 8 times the scene is refused.
    pub edge: f32,
    /// Lattice cells along each axis. Range 2 to 1024; default (8, 8, 8).
    ///
    /// Fewer than 4 are too stiff in bending to look like a sponge.
    #[cfg_attr(feature = "serde", schemars(with = "[u32; 3]"))]
    pub cells: UVec3,
    /// Lowest corner of the lattice block. Range -1000 to 1000 m; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub position: Vec3,
    /// Shape that is cut out of the block; default all of it.
    pub shape: BlockShape,
    /// Velocity at time zero. Range -100 to 100 m/s; default (0, 0, 0).
    #[cfg_attr(feature = "serde", schemars(with = "[f32; 3]"))]
    pub velocity: Vec3,
    /// Mass of the dry sponge over its volume, pores included. Range 1 to 5000 kg/m^3; default 50.
    ///
    /// A block weighs this times the volume of its box. Below 10 the lattice is so light that noise of the water pressure
    /// shakes it.
    pub density: f32,
    /// Porosity: pore volume over volume. Range 0.05 to 0.99; default 0.9.
    pub porosity: f32,
    /// Permeability of the sponge at rest: lower values let water in and out more slowly. Range 1e-14 to 1e-5 m^2; default
    /// 1e-9.
    ///
    /// With `fluid.coupling = "porous"` it falls as compression closes pores, after Kozeny and Carman:
    /// `K (phi / phi_0)^3 ((1 - phi_0) / (1 - phi))^2`.
    pub permeability: f32,
    /// Forchheimer coefficient: drag in proportion to the square of the speed of the water. The drag per volume of sponge is
    /// `viscosity / permeability * q + density * forchheimer / sqrt(permeability) * q^2` for a flow q per area. Range 0 to
    /// 2; default 0. Foams have about 0.1, beds of grains 0.5. With `fluid.coupling = "porous"`.
    pub forchheimer: f32,
    /// Capillary pressure of the saturated sponge. Water climbs to about this over (density * gravity). Range 0 to 100000
    /// Pa; default 500.
    ///
    /// Above 2000 a layer of water forms around the sponge.
    pub entry_pressure: f32,
    /// Support radius of the suction of a node, in `edge`s. Range 1 to 2.5; default 1.5.
    ///
    /// Below 1 there are points that no node reaches.
    pub suction_radius: f32,
    /// Additional suction of a dry sponge, over that of a saturated one. Range 0 to 5; default 1.
    ///
    /// Control pressure = `-entry_pressure * (1 + saturation_gain * (1 - saturation))`.
    pub saturation_gain: f32,
    /// Stiffness of the zero-distance constraint that returns the suction to the sponge, over that of the exact reaction.
    /// Range 0 to 2; default 1.
    ///
    /// At 1 momentum is conserved, and a sponge standing in water stays in place.
    pub reaction: f32,
    /// Elastic solver: `vbd` (default), `sbd` or `xpbd_neo_hookean`.
    pub solver: Solver,
    /// Young's modulus of the sponge with its pores: stress over strain of a bar in tension. Range 10 to 1e9 Pa; default 20000.
    /// Of `vbd` and `xpbd_neo_hookean`, like the next two.
    pub young_modulus: f32,
    /// Poisson's ratio: transverse contraction over elongation of a bar. Range 0 to 0.49; default 0.2.
    ///
    /// Above 0.45 the lattice itself is too stiff.
    pub poisson_ratio: f32,
    /// Damping time (Kelvin-Voigt): viscous stress over elastic stress per strain rate. Range 0 to 10 s; default 0.
    ///
    /// A vibration of angular frequency `w` decays at the rate `damping * w * w / 2`. The solver itself damps about as much
    /// as a damping time of one step. `xpbd_neo_hookean` becomes soft where this is long compared with the time in which an
    /// elastic wave crosses a cell, `edge * sqrt(density / young_modulus)`.
    pub damping: f32,
    /// Stiffness of `sbd` against stretching. Range 10 to 1e9 Pa; default 20000.
    pub stretch_modulus: f32,
    /// Stiffness of `sbd` against shearing. Range 10 to 1e9 Pa; default 10000.
    pub shear_modulus: f32,
    /// Stiffness of `sbd` against changes of volume. Range 10 to 1e9 Pa; default 20000.
    pub volume_modulus: f32,
    /// Time in which internal vibrations of `sbd` decay. Range 0 to 10 s; default 5e-4.
    pub damping_time: f32,
    /// Solver sweeps per step. Range 1 to 64; default 4.
    ///
    /// `vbd`: more sweeps follow fast motion better, and statics are exact at any number. `sbd`: more sweeps are stiffer
    /// under load, and the paper uses 1. `xpbd_neo_hookean` always takes one. Cost grows in proportion.
    pub iterations: u32,
    /// Coulomb friction against walls. Two sponges have the mean of both. Range 0 to 10; default 0.5.
    pub friction: f32,
    /// Whether the sponge can touch itself where it is folded or wrung; default false. With `solver = "vbd"`. Nodes less
    /// than four edges apart at rest never touch. Different sponges of this solver always touch each other.
    pub self_contact: bool,
    /// Water-filled pore volume over pore volume at time zero. Range 0 to 1; default 0.
    pub saturation: f32,
    /// Share of its stiffness that wet material loses: Young's modulus is `young_modulus * (1 - softening * wetness)`. Range
    /// 0 to 0.95; default 0. Cellulose loses 0.5 to 0.9. With `fluid.coupling = "porous"`, like the next four.
    pub softening: f32,
    /// Elongation of wet material at rest: an edge of the lattice is `edge * (1 + swelling * wetness)`. Range 0 to 0.5;
    /// default 0. Cellulose has 0.1 to 0.3. The mass of the material and its volume without pores are constant: pores become
    /// wider.
    pub swelling: f32,
    /// Time constant with which the wetness of the material follows its saturation. Range 0 to 1000 s; default 0.1.
    ///
    /// At time zero all material is dry. Much below 0.05, `swelling` shakes the sponge as single particles pass.
    pub wetting_time: f32,
    /// Exponent n of the relative permeability `k_r = S^n` at saturation S. The flow under any pressure gradient is in
    /// proportion to `permeability * k_r` over the viscosity. Range 1 to 8; default 1, at which the velocity of the water
    /// does not depend on S. Brooks and Corey have `3 + 2 / l` for a pore size distribution index l, 3 to 4 in foams.
    pub relative_permeability_exponent: u32,
    /// Capillary pressure against which water leaves pores, where `entry_pressure` is that at which it enters them. A sponge
    /// that is lifted out of water holds a column of about this over (density * gravity). Range 0 to 100000 Pa; default 0,
    /// which stands for `entry_pressure`, the smallest other value.
    ///
    /// Both are positive where they hold water. A node goes from one to the other while its saturation changes by a tenth.
    pub receding_pressure: f32,
    /// Whether it came while the scene ran, by `Command::AddSponge`. No body of time zero cuts it then, and it may overlap other
    /// sponges of time zero. Default false.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub added: bool,
}

impl Default for Sponge {
    fn default() -> Self {
        Self {
            name: "sponge".to_owned(),
            edge: 0.01,
            cells: UVec3::splat(8),
            position: Vec3::ZERO,
            shape: BlockShape::Block,
            velocity: Vec3::ZERO,
            density: 50.0,
            porosity: 0.9,
            permeability: 1e-9,
            forchheimer: 0.0,
            entry_pressure: 500.0,
            suction_radius: 1.5,
            saturation_gain: 1.0,
            reaction: 1.0,
            solver: Solver::Vbd,
            young_modulus: 2e4,
            poisson_ratio: 0.2,
            damping: 0.0,
            stretch_modulus: 2e4,
            shear_modulus: 1e4,
            volume_modulus: 2e4,
            damping_time: 0.0005,
            iterations: 4,
            friction: 0.5,
            self_contact: false,
            saturation: 0.0,
            softening: 0.0,
            swelling: 0.0,
            wetting_time: 0.1,
            relative_permeability_exponent: 1,
            receding_pressure: 0.0,
            added: false,
        }
    }
}

impl Sponge {
    /// Cube of 8 x 8 x 8 cells of 1 cm with its lowest corner at a position \[m\].
    #[must_use]
    pub fn new(name: &str, position: Vec3) -> Self {
        Self { name: name.to_owned(), position, ..Self::default() }
    }

    /// What a removed sponge leaves behind: one without nodes.
    pub(crate) fn removed(index: usize, own: &Self) -> Self {
        let (name, cells) = (format!("{REMOVED}sponge-{index}"), UVec3::splat(2));
        let (edge, solver, position) = (own.edge, own.solver, NOWHERE);
        Self { name, edge, cells, position, solver, ..Self::default() }
    }

    /// Whether it is what [`Command::RemoveSponge`](crate::Command::RemoveSponge) has left behind.
    #[must_use]
    pub fn is_removed(&self) -> bool {
        self.position == NOWHERE && self.name.starts_with(REMOVED)
    }

    /// Size of the lattice block \[m\].
    #[must_use]
    pub fn size(&self) -> Vec3 {
        self.edge * self.cells.as_vec3()
    }

    /// Whether a property depends on the wetness of the sponge.
    #[must_use]
    pub fn depends_on_wetness(&self) -> bool {
        let [softening, swelling] = [self.softening, self.swelling];
        softening > 0.0
            || swelling > 0.0
            || self.relative_permeability_exponent > 1
            || self.receding_pressure > self.entry_pressure
    }

    /// Suction of dry material \[Pa\].
    #[must_use]
    pub fn largest_suction(&self) -> f32 {
        self.entry_pressure.max(self.receding_pressure) * (1.0 + self.saturation_gain)
    }

    /// Highest corner of the lattice block \[m\].
    #[must_use]
    pub fn maximum(&self) -> Vec3 {
        self.position + self.size()
    }
}
