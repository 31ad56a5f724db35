//! Parameters of a sponge.

use crate::layout::{enumeration, layout};

enumeration! {
    /// How a sponge is solved.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Solver {
        /// Strain constraints on the tets, one after the other (`pbd::strain`).
        Sbd,
        /// Vertex block descent on the energy of the nodes (`pbd::vbd`).
        Vbd,
        /// Two coupled constraints per tet (`pbd::xpbd_neo_hookean`).
        XpbdNeoHookean,
    }
}

layout! {
    /// One sponge.
    #[derive(Clone, Debug)]
    pub struct SpongeParams as Sponge {
        /// Lattice constant \[m\].
        pub edge: f32,
        /// How it is solved.
        pub solver: Solver,
        /// Shear constant mu of the Neo-Hookean energies \[Pa\]; of `vbd` and `xpbd_neo_hookean`, like the next two.
        pub mu: f32,
        /// Volume constant lambda of those energies, the first Lame constant plus mu \[Pa\].
        pub lambda: f32,
        /// Ratio of viscous to elastic stress per strain rate \[s\].
        pub damping: f32,
        /// Energy density per squared stretch \[Pa\].
        pub stretch_modulus: f32,
        /// Energy density per squared shear \[Pa\].
        pub shear_modulus: f32,
        /// Energy density per squared change of volume \[Pa\].
        pub volume_modulus: f32,
        /// Ratio of viscous to elastic stress per strain rate of `sbd` \[s\].
        pub damping_time: f32,
        /// Solver iterations of a step.
        pub iterations: u32,
        /// Coulomb friction of nodes against the walls, and their part in that against other sponges \[1\].
        pub friction: f32,
        /// Whether the sponge may touch itself (`pbd::pairs`).
        pub self_contact: bool,
        /// Pore volume over volume \[1\].
        pub porosity: f32,
        /// Rate at which a full sponge takes water to its own velocity, mu phi / (rho K) \[1/s\].
        pub drag_rate: f32,
        /// The same per speed of the water beside the sponge, `c_F phi^2 / sqrt(K)` \[1/m\].
        pub inertial_drag_rate: f32,
        /// Whether porosity and permeability fall as the sponge is compressed.
        pub pores_close: bool,
        /// Suction of a saturated node \[Pa\].
        pub entry_pressure: f32,
        /// Further suction of a dry node, over the entry pressure \[1\].
        pub saturation_gain: f32,
        /// Stiffness of the zero-distance constraint over that of the exact reaction \[1\].
        pub reaction: f32,
        /// What properties do as the material becomes wet.
        pub wetting: WettingParams,
    }
}

layout! {
    /// What properties of a sponge do as it becomes wet; the default is nothing at all.
    #[derive(Clone, Debug, PartialEq)]
    pub struct WettingParams as Wetting {
        /// Share of `mu` and `lambda` that wet material lacks \[1\].
        pub softening: f32,
        /// Elongation of wet material at rest \[1\].
        pub swelling: f32,
        /// Time in which material becomes as wet as its pores are filled \[s\].
        pub time: f32,
        /// Exponent n of the relative permeability `S^n` \[1\].
        pub exponent: u32,
        /// Further suction of a node whose saturation falls \[Pa\].
        pub receding: f32,
    }
}

impl Default for WettingParams {
    fn default() -> Self {
        Self { softening: 0.0, swelling: 0.0, time: 0.0, exponent: 1, receding: 0.0 }
    }
}

impl WettingParams {
    /// Whether any property depends on it.
    #[must_use]
    pub fn is_any(&self) -> bool {
        self.changes_material() || self.exponent > 1 || self.receding > 0.0
    }

    /// Whether wet material is softer or larger than dry material.
    #[must_use]
    pub fn changes_material(&self) -> bool {
        self.softening > 0.0 || self.swelling > 0.0
    }

    /// Length of wet material at rest over that of dry material.
    #[must_use]
    pub fn size(&self, wetness: f32) -> f32 {
        1.0 + self.swelling * wetness
    }

    /// Stiffness of wet material over that of dry material.
    #[must_use]
    pub fn stiffness(&self, wetness: f32) -> f32 {
        1.0 - self.softening * wetness
    }
}

impl SpongeParams {
    /// Longest edge that the lattice has at rest, however wet it is \[m\].
    pub(crate) fn contact_edge(&self) -> f32 {
        self.edge * self.wetting.size(1.0)
    }

    /// Control pressure of a node at a saturation \[Pa\], below zero; `receding` is 0 where water advances and 1 where it recedes.
    pub(crate) fn control_pressure(&self, saturation: f32, receding: f32) -> f32 {
        let dry = 1.0 - saturation;
        let dry = if dry < 0.0 { 0.0 } else { dry };
        -(self.entry_pressure + receding * self.wetting.receding) * (1.0 + self.saturation_gain * dry)
    }

    /// Constants of the Neo-Hookean energies, `mu` and `lambda` \[Pa\], of Young's modulus \[Pa\] and Poisson's ratio.
    ///
    /// Near rest the energies are that of a linear material with `mu` and a first Lame constant of `lambda - mu`.
    #[must_use]
    pub fn neo_hookean(young_modulus: f32, poisson_ratio: f32) -> (f32, f32) {
        let (young, poisson) = (f64::from(young_modulus), f64::from(poisson_ratio));
        let mu = young / (2.0 * (1.0 + poisson));
        let lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        (mu as f32, (lame + mu) as f32)
    }
}
