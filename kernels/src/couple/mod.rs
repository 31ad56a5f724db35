//! Fluid and sponge: nodes as control particles of the fluid (the paper, section 3.3).

pub mod control_velocity;
pub mod controls;
pub mod drag;
pub mod exchange;
pub mod interior;
pub mod saturation;
pub mod suction;
pub mod velocity_filter;
#[cfg(feature = "gpu")]
pub mod weights;
pub mod zero_distance;
