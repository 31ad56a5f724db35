//! The C interface of sorb; `include/sorb.h` is made of it.
//!
//! Rules of the border: every function that can fail returns a [`Status`], and [`sorb_last_error`] has the text.
//! A panic becomes a status, and the world in which it happened is refused from then on. No side frees what the other allocated. Lengths
//! come with every buffer, sizes in every struct that may grow.
//!
//! What a caller must keep to: a pointer is null or points to as much memory of its type as the function says. A handle was given by this
//! library and not freed. No two threads use the same handle at the same time. Nothing else is trusted.
#![allow(unsafe_code, reason = "pointers of callers; every use says why it is sound")]
#![allow(clippy::missing_safety_doc, reason = "the crate says once what a caller must keep to")]

mod body;
mod change;
mod column;
mod command;
mod failure;
mod memory;
mod options;
mod query;
mod recording;
mod report;
mod scene;
mod state;
mod world;

pub use body::*;
pub use change::*;
pub use column::*;
pub use command::*;
pub use failure::{Status, sorb_last_error, sorb_status_name};
pub use options::*;
pub use query::*;
pub use recording::*;
pub use report::*;
pub use scene::*;
pub use state::*;
pub use world::*;
