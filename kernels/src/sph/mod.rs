//! The fluid: smoothed particle hydrodynamics, with an equation of state (the paper, section 3.1) or with a solve for
//! the pressure that keeps the density \[BK17\].

pub mod advect;
pub mod boundary;
pub mod boundary_pressure;
pub mod boundary_reaction;
pub mod cohesion;
pub mod deficit;
pub mod density;
pub mod factors;
pub mod forces;
pub mod kick;
pub mod position_correction;
pub mod predict;
pub mod pressure;
pub mod pressure_acceleration;
pub mod pressure_kick;
pub mod pressure_residual;
pub mod pressure_solve;
pub mod pressure_update;
pub mod repulsion;
pub mod surface_tension;
pub mod sweep;
pub(crate) mod viscosity;
pub mod viscosity_begin;
pub mod viscosity_kick;
pub mod viscosity_product;
pub mod viscosity_reaction;
pub mod viscosity_solve;
pub mod viscosity_update;
pub mod wall_friction;
