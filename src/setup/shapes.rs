//! Shapes of a scene as bodies and sponges need them.

use glam::Vec3;

use crate::{
    rigid::Shape,
    scene::{Body, ShapeKind, Sponge, SpongeShape},
    sponge,
    world::WorldError,
};

/// Whether a point of the unit cube of a block belongs to a sponge.
pub(super) type Mask = Box<dyn Fn(Vec3) -> bool>;

/// The shape of a body about its centre of mass, for water of particles at a spacing \[m\], and the place of the centre of mass in the
/// frame of the scene's shape \[m\].
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
            _ => return Err(WorldError::NeedsRigid { body: body.name.clone() }),
        }
        .map_err(refused)
    }
    #[cfg(not(feature = "rigid"))]
    {
        let _ = (spacing, ShapeKind::Plane);
        Err(WorldError::NeedsRigid { body: body.name.clone() })
    }
}

/// The shapes of sponges.
pub(super) fn masks(sponges: &[Sponge]) -> Result<Vec<Mask>, WorldError> {
    sponges.iter().map(mask).collect()
}

fn mask(sponge: &Sponge) -> Result<Mask, WorldError> {
    Ok(match &sponge.shape {
        SpongeShape::Block => Box::new(sponge::block),
        SpongeShape::Ellipsoid => Box::new(sponge::ellipsoid),
        SpongeShape::Cylinder { axis } => Box::new(sponge::cylinder(*axis)),
        SpongeShape::Mesh { mesh } => {
            let what = || format!("sponge `{}`", sponge.name);
            let mesh = mesh.solid().map_err(|source| WorldError::Mesh { what: what(), source })?;
            #[cfg(feature = "rigid")]
            {
                Box::new(sponge::solid(mesh, sponge.size()))
            }
            #[cfg(not(feature = "rigid"))]
            {
                let _ = mesh;
                return Err(WorldError::NeedsRigid { body: sponge.name.clone() });
            }
        }
    })
}
