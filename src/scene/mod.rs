//! Declarative scenes: the content of the world at time zero, in SI units, Y up.
//!
//! A [`Scene`] is plain data. Build one in code with struct update syntax, or read a TOML or JSON file with the feature
//! `serde`. Every number has a documented range. One table ([`limits`](fn@limits)) is the source of the validation, the JSON
//! schema and a test of these docs.
//!
//! ```
//! use glam::Vec3;
//! use sorb::scene::{Fluid, FluidBlock, Scene, Sponge};
//!
//! let scene = Scene::new("bath")
//!     .in_box(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.2, 0.1))
//!     .with_fluid(Fluid {
//!         blocks: vec![FluidBlock::new(Vec3::new(-0.1, 0.0, -0.1), Vec3::new(0.1, 0.02, 0.1))],
//!         ..Fluid::default()
//!     })
//!     .with_sponge(Sponge { permeability: 4e-9, ..Sponge::new("sponge", Vec3::new(-0.04, 0.0, -0.04)) });
//! scene.validate()?;
//! # Ok::<(), sorb::scene::SceneError>(())
//! ```

use crate::rigid::{BodyKind, BodyState, Shape};

mod block;
mod bodies;
mod body_rules;
mod camera;
mod container;
mod error;
mod estimate;
mod flows;
mod fluid;
mod fluid_block;
mod limits;
mod material;
mod mesh;
mod motion;
mod number;
mod scaled;
mod sponge;
mod top;
mod validate;

#[cfg(feature = "serde")]
mod check;
#[cfg(feature = "serde")]
mod json;
#[cfg(feature = "serde")]
mod key;
#[cfg(feature = "serde")]
mod locate;
#[cfg(feature = "serde")]
mod overrides;
#[cfg(feature = "serde")]
mod presets;
#[cfg(feature = "serde")]
mod quality;
#[cfg(feature = "serde")]
mod schema;
#[cfg(feature = "serde")]
mod text;

#[cfg(test)]
mod tests;

pub use block::{Axis, BlockShape};
pub use bodies::{Body, Look, Rotation, ShapeKind};
pub(crate) use bodies::{KindKey, REMOVED};
pub use camera::Camera;
pub(crate) use container::container_problems;
pub use container::{Container, GravityKey};
pub use error::{Defect, Problem, SceneError};
pub use estimate::{Estimate, MAXIMUM_NODES, MAXIMUM_PARTICLES};
pub use flows::{Drain, Emitter};
pub use fluid::{
    Coupling, CouplingWeights, EquationOfState, Fluid, FluidSolver, ViscosityForm, ViscosityIntegration,
};
pub use fluid_block::FluidBlock;
pub(crate) use limits::limit;
pub use limits::{Limit, limits};
pub use material::Material;
pub use mesh::Mesh;
pub use motion::Motion;
pub(crate) use number::number_text;
#[cfg(feature = "serde")]
pub use presets::{Preset, preset, presets};
#[cfg(feature = "serde")]
pub use quality::Quality;
#[cfg(feature = "serde")]
pub use schema::schema;
pub use sponge::{Solver, Sponge};
pub use top::{Domain, Scene, Time, VERSION};
