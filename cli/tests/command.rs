//! The command from the outside: exit codes, messages, files.

#[path = "command/exports.rs"]
mod exports;
#[path = "command/render.rs"]
mod render;
#[path = "command/replays.rs"]
mod replays;
#[path = "command/runs.rs"]
mod runs;
#[path = "command/scenes.rs"]
mod scenes;
#[path = "command/support.rs"]
mod support;
#[cfg(feature = "surface")]
#[path = "command/surfaces.rs"]
mod surfaces;
#[path = "command/sweeps.rs"]
mod sweeps;
#[path = "command/usage.rs"]
mod usage;
#[cfg(feature = "validation")]
#[path = "command/validate.rs"]
mod validate;
#[path = "command/without_features.rs"]
mod without_features;
