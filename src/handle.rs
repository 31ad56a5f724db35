//! Names of what comes and goes: a place in a list, and how often the place was taken before.

use serde::{Deserialize, Serialize};

macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident;)+) => {
        $(
            $(#[$doc])*
            ///
            /// It names one thing for ever: once that is removed the handle is stale, and commands that hold it are refused.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
            pub struct $name {
                index: u32,
                generation: u32,
            }

            impl $name {
                #[allow(dead_code, reason = "what nothing takes the place of has one generation")]
                pub(crate) const fn new(index: u32, generation: u32) -> Self {
                    Self { index, generation }
                }

                /// Its number among those of its kind.
                #[must_use]
                pub const fn index(self) -> usize {
                    self.index as usize
                }

                /// How many had this number before it.
                #[must_use]
                pub const fn generation(self) -> u32 {
                    self.generation
                }
            }

            /// That of the scene, by its number there, from 0.
            impl From<u32> for $name {
                fn from(index: u32) -> Self {
                    Self { index, generation: 0 }
                }
            }

            impl std::fmt::Display for $name {
                fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                    match self.generation {
                        0 => write!(out, "{}", self.index),
                        generation => write!(out, "{} (generation {generation})", self.index),
                    }
                }
            }
        )+
    };
}

handles! {
    /// A rigid body.
    BodyHandle;
    /// A sponge.
    SpongeHandle;
}
