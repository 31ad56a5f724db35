//! Shapes of blocks of water and of sponges.

use glam::Vec3;

use super::{Mesh, Problem, limits, validate::check};

/// A coordinate axis; Y is up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The first axis.
    X,
    /// The upward axis.
    #[default]
    Y,
    /// The third axis.
    Z,
}

/// Shape that is cut out of a block of water, or of the lattice of a sponge.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "serde", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum BlockShape {
    /// The whole block.
    #[default]
    Block,
    /// The ellipsoid that touches all six faces of the block.
    Ellipsoid,
    /// The (elliptic) cylinder that touches four faces of the block.
    Cylinder {
        /// Axis of the cylinder.
        axis: Axis,
    },
    /// What a mesh encloses: as large as fits into the block, in its middle, without distortion.
    Mesh {
        /// The surface.
        mesh: Mesh,
    },
}

impl BlockShape {
    /// Adds the problems of its numbers, of the shape at a key such as `sponges[0].shape`.
    pub(crate) fn ranges(&self, key: &str, problems: &mut Vec<Problem>) {
        if let Self::Mesh { mesh } = self {
            check(mesh, limits::MESH, &format!("{key}.mesh."), problems);
        }
    }

    /// Adds what else is wrong with it.
    pub(crate) fn rules(&self, key: &str, problems: &mut Vec<Problem>) {
        if let Self::Mesh { mesh } = self {
            mesh.rules(&format!("{key}.mesh"), problems);
        }
    }

    /// Whether a point lies in what a mask cuts out of a block with a lowest corner and a size \[m\].
    pub(crate) fn holds(mask: impl Fn(Vec3) -> bool, (low, size): (Vec3, Vec3), point: Vec3) -> bool {
        let relative = (point - low) / size;
        relative.cmpge(Vec3::ZERO).all() && relative.cmple(Vec3::ONE).all() && mask(relative)
    }

    /// Volume of the ideal shape over that of its block \[1\].
    #[must_use]
    pub fn fraction(&self) -> f64 {
        match self {
            Self::Block => 1.0,
            Self::Ellipsoid => std::f64::consts::PI / 6.0,
            Self::Cylinder { .. } => std::f64::consts::PI / 4.0,
            // An estimate: the proportions of the block may be others.
            Self::Mesh { mesh } => mesh.solid().map_or(1.0, |mesh| {
                let (low, high) = mesh.bounds();
                (mesh.volume() / (high - low).as_dvec3().element_product()).clamp(0.0, 1.0)
            }),
        }
    }
}
