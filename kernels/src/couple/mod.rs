//! Fluid and sponge: nodes as control particles of the fluid (the paper, section 3.3).

pub mod control_velocity;
pub mod controls;
pub mod drag;
pub mod drag_impulse;
pub mod drag_kick;
pub mod drag_reaction;
pub mod drag_settled;
pub mod drag_target;
pub mod exchange;
pub mod interior;
pub mod node_velocity;
pub mod pores;
pub mod saturation;
pub mod solid_pressure;
pub mod solid_reaction;
pub mod solid_share;
pub mod solid_yield;
pub mod suction;
pub mod velocity_filter;
#[cfg(feature = "gpu")]
pub mod weights;
pub mod wetting;
pub mod zero_distance;
