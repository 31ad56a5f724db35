//! Tables and formulas with their sources.

pub mod beam;
pub mod darcy;
pub mod floating;
pub mod kleefsman;
pub mod martin_moyce;
pub mod taylor_green;
pub mod terzaghi;
