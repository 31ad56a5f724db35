//! Scenes that try to break the defaults: `dfsph`, `vbd`, sponges as porous media.
//!
//! Steps are taken or refused with a reason, the state stays finite and inside, no water is lost, and energy is within its
//! budget. `docs/stress.md` has the results.
//!
//! `SORB_STRESS=1 cargo test --workspace --test stress -- --nocapture` runs the long form and prints the table.

#[path = "../common/mod.rs"]
mod common;

mod bodies;
mod case;
mod digests;
mod energy;
mod extremes;
mod materials;
mod parser;
mod random;
mod scenes;
mod soak;
mod squeezed;

/// Whether the long form is requested.
fn long() -> bool {
    std::env::var_os("SORB_STRESS").is_some()
}

/// One of two values: the second in the long form.
fn pick<T>(short: T, long_form: T) -> T {
    if long() { long_form } else { short }
}
