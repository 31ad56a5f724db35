//! The sponge: elasticity of the lattice, by strain constraints on tets (the paper, section 3.2), by vertex block
//! descent or by Neo-Hookean constraints, and contact of its nodes.

pub mod contact;
mod descent;
pub mod flatness;
pub mod gravity;
pub mod guess;
pub mod lattice;
pub mod momentum;
mod obstacles;
pub mod pairs;
pub mod predict;
pub mod reaction;
pub mod stars;
pub mod strain;
mod tets;
pub mod touch;
pub mod vbd;
pub mod velocity;
pub mod wetted;
pub mod xpbd_neo_hookean;
