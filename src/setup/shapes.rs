//! Shapes of a scene as bodies, sponges and blocks of water need them.

use glam::Vec3;

use crate::{
    rigid::Shape,
    scene::{BlockShape, Body, ShapeKind, Sponge},
    sponge,
    world::WorldError,
};

/// Whether a point of the unit cube of a block belongs to what is cut out of it.
pub(crate) type Mask = Box<dyn Fn(Vec3) -> bool>;

/// The shape of a body about its centre of mass, for water of particles at a spacing \[m\]. Beside it the place of the centre of mass in
/// the frame of the scene's shape \[m\].
pub(super) fn shape_of(body: &Body, spacing: f32) -> Result<(Shape, Vec3), WorldError> {
    if let Some(shape) = body.shape.primitive() {
        return Ok((shape, Vec3::ZERO));
    }
    #[cfg(feature = "rigid")]
    {
        use crate::rigid;
        let refused = |source| WorldError::Hull { body: body.name.clone(), source };
        match &body.shape {
            ShapeKind::Hull { vertices } => {
                rigid::convex_hull(vertices).map(|hull| (hull.shape, hull.offset))
            }
            ShapeKind::Cup { radius, height, thickness } => {
                rigid::cup([*radius, *height, *thickness], spacing)
            }
            ShapeKind::Mesh { mesh, parts } => {
                let mesh = mesh
                    .solid()
                    .map_err(|source| WorldError::Mesh { what: format!("body `{}`", body.name), source })?;
                rigid::mesh_body(&mesh, *parts, spacing)
            }
            _ => return Err(WorldError::NeedsRigid { what: format!("body `{}`", body.name) }),
        }
        .map_err(refused)
    }
    #[cfg(not(feature = "rigid"))]
    {
        let _ = (spacing, ShapeKind::Plane);
        Err(WorldError::NeedsRigid { what: format!("body `{}`", body.name) })
    }
}

/// The shapes of sponges.
pub(super) fn masks(sponges: &[Sponge]) -> Result<Vec<Mask>, WorldError> {
    sponges
        .iter()
        .map(|sponge| mask(&sponge.shape, sponge.size(), &format!("sponge `{}`", sponge.name)))
        .collect()
}

/// What is cut out of a block of some size \[m\], which an error names.
pub(crate) fn mask(shape: &BlockShape, size: Vec3, owner: &str) -> Result<Mask, WorldError> {
    Ok(match shape {
        BlockShape::Block => Box::new(sponge::block),
        BlockShape::Ellipsoid => Box::new(sponge::ellipsoid),
        BlockShape::Cylinder { axis } => Box::new(sponge::cylinder(*axis)),
        BlockShape::Mesh { mesh } => {
            let mesh = mesh.solid().map_err(|source| WorldError::Mesh { what: owner.to_owned(), source })?;
            #[cfg(feature = "rigid")]
            {
                Box::new(sponge::solid(mesh, size))
            }
            #[cfg(not(feature = "rigid"))]
            {
                let _ = (mesh, size);
                return Err(WorldError::NeedsRigid { what: owner.to_owned() });
            }
        }
    })
}
