//! What of a sponge can change while a world runs.

use serde::{Deserialize, Serialize};

use super::Sponge;

macro_rules! material {
    ($($field:ident: $type:ty,)+) => {
        /// The material of a sponge: those keys of [`Sponge`] that can change while a world runs, with their units, ranges and rules. What
        /// makes its lattice, its solver and the radius of its suction stay.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct Material {
            $(
                #[doc = concat!("As [`Sponge::", stringify!($field), "`].")]
                pub $field: $type,
            )+
        }

        impl Material {
            /// Gives a sponge this material.
            pub fn put(&self, sponge: &mut Sponge) {
                $(sponge.$field = self.$field;)+
            }
        }

        impl From<&Sponge> for Material {
            fn from(sponge: &Sponge) -> Self {
                Self { $($field: sponge.$field,)+ }
            }
        }
    };
}

material! {
    density: f32,
    porosity: f32,
    permeability: f32,
    forchheimer: f32,
    entry_pressure: f32,
    saturation_gain: f32,
    reaction: f32,
    young_modulus: f32,
    poisson_ratio: f32,
    damping: f32,
    stretch_modulus: f32,
    shear_modulus: f32,
    volume_modulus: f32,
    damping_time: f32,
    iterations: u32,
    friction: f32,
    softening: f32,
    swelling: f32,
    wetting_time: f32,
    relative_permeability_exponent: u32,
    receding_pressure: f32,
}

impl Default for Material {
    fn default() -> Self {
        Self::from(&Sponge::default())
    }
}
