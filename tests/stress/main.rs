//! Scenes that try to break the defaults: `dfsph`, `vbd`, sponges as porous media.
//!
//! Whatever is asked of them, steps are taken or refused with a reason, the state stays finite and inside, water is not
//! lost, and energy does not come from nowhere. `docs/stress.md` says what was thrown at them and what happened.
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

/// Whether the long form is asked for.
fn long() -> bool {
    std::env::var_os("SORB_STRESS").is_some()
}

/// One of two values: the second in the long form.
fn pick<T>(short: T, long_form: T) -> T {
    if long() { long_form } else { short }
}
