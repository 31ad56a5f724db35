//! The fluid: smoothed particle hydrodynamics with an equation of state (the paper, section 3.1).

pub mod advect;
pub mod density;
pub mod forces;
pub mod kick;
pub mod pressure;
pub mod repulsion;
pub mod surface_tension;
