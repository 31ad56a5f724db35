//! The sponge: position based dynamics with strain constraints on tets (the paper, section 3.2).

pub mod contact;
pub mod gravity;
pub mod lattice;
pub mod predict;
pub mod strain;
pub mod velocity;
