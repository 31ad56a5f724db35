//! Tables and formulas with their sources.

pub mod beam;
pub mod channel;
pub mod darcy;
pub mod drop;
pub mod floating;
pub mod kleefsman;
pub mod martin_moyce;
pub mod potential;
pub mod shear;
pub mod sinking;
pub mod taylor_green;
pub mod terzaghi;
