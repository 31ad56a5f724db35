//! Names of what comes and goes: a place in a list, and how often the place was taken before.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident;)+) => {
        $(
            $(#[$doc])*
            ///
            /// It names one thing for ever: once that is removed the handle is stale, and commands that hold it are refused. In JSON it is
            /// its number, or `{"index": 0, "generation": 1}` where others had the number before.
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
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

            impl Serialize for $name {
                fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                    write(self.index, self.generation, serializer)
                }
            }

            impl<'de> Deserialize<'de> for $name {
                fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                    read(deserializer).map(|(index, generation)| Self { index, generation })
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

/// Both numbers by name.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Both {
    index: u32,
    generation: u32,
}

/// What text may hold.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a number from 0, or {\"index\": .., \"generation\": ..}")]
enum Text {
    Index(u32),
    Both(Both),
}

fn write<S: Serializer>(index: u32, generation: u32, serializer: S) -> Result<S::Ok, S::Error> {
    if serializer.is_human_readable() && generation == 0 {
        index.serialize(serializer)
    } else {
        Both { index, generation }.serialize(serializer)
    }
}

fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(u32, u32), D::Error> {
    let text = if deserializer.is_human_readable() {
        Text::deserialize(deserializer)?
    } else {
        Text::Both(Both::deserialize(deserializer)?)
    };
    Ok(match text {
        Text::Index(index) => (index, 0),
        Text::Both(Both { index, generation }) => (index, generation),
    })
}

handles! {
    /// A rigid body.
    BodyHandle;
    /// A sponge.
    SpongeHandle;
}

/// An emitter or a drain: its number, which no other has before or after it. Once it has ended the handle is stale, and commands that hold
/// it are refused. In JSON it is the number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(transparent)]
pub struct FlowHandle(u32);

impl FlowHandle {
    /// Its number.
    #[must_use]
    pub const fn number(self) -> u32 {
        self.0
    }
}

/// That of the scene, by its number there: emitters from 0, then drains.
impl From<u32> for FlowHandle {
    fn from(number: u32) -> Self {
        Self(number)
    }
}

impl std::fmt::Display for FlowHandle {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_holds_the_number_alone_where_nothing_had_it_before() {
        let first = BodyHandle::from(3);
        let later = BodyHandle::new(3, 2);
        for (handle, text) in [(first, "3"), (later, r#"{"index":3,"generation":2}"#)] {
            assert_eq!(serde_json::to_string(&handle).ok().as_deref(), Some(text));
            assert_eq!(serde_json::from_str::<BodyHandle>(text).ok(), Some(handle));
        }
        for wrong in ["-1", "\"ball\"", r#"{"index":3}"#, "4294967296"] {
            let error = serde_json::from_str::<BodyHandle>(wrong).map_err(|error| error.to_string());
            assert!(error.as_ref().is_err_and(|text| text.contains("a number from 0")), "{wrong}: {error:?}");
        }
    }
}
